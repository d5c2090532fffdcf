#include "core/recognition/prior/touched_prior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/modes/touched_curve.h"
#include "core/recognition/prior/arc_coordinates.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

TouchedShape random_shape(CurveClass curve_class, std::mt19937_64& rng) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
  };
  switch (curve_class) {
    case CurveClass::Ellipse:
      return {{2.0, in(0.2, 1.9), 0.0}, in(-3.0, 3.0)};
    case CurveClass::CubicalParabola:
      return {{std::copysign(in(0.1, 3.0), in(-1.0, 1.0)), in(-2.0, 2.0), 0.0}, in(-1.0, 1.0)};
    case CurveClass::CubicSpline:
      return {{in(0.1, 3.0), in(-2.0, 2.0), in(-2.0, 2.0)}, in(-1.0, 1.0)};
    case CurveClass::SemiCubicalParabola:
      return {{in(0.1, 3.0), in(-2.0, 2.0), 0.0}, in(0.2, 2.0)};
    default:
      return {{in(0.1, 3.0), in(0.1, 3.0), 0.0}, in(-2.0, 2.0)};
  }
}

class TouchedCoordinatesOf : public testing::TestWithParam<Chart> {};

TEST_P(TouchedCoordinatesOf, ThereAndBack) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 100; ++i) {
    const TouchedShape shape = random_shape(GetParam().curve_class, rng);
    const auto back = shape_at(GetParam(), coordinates_of(GetParam(), shape), shape);
    ASSERT_TRUE(back.has_value());
    const auto letters = static_cast<int>(parameter_letters(GetParam().curve_class).size());
    for (int k = 0; k < letters; ++k) {
      // Logarithms and squares of numbers of order 1: a few roundings.
      EXPECT_NEAR(back->values[k], shape.values[k], 1e-14 * (1.0 + std::abs(shape.values[k])));
    }
    if (shape_coordinates(GetParam().curve_class) > letters) {  // the place is a coordinate
      EXPECT_NEAR(wrap_angle(back->t - shape.t), 0.0, 1e-13);
    }
  }
}

/// Integral over coordinate k of exp(log_prior_at(z)), over what a normal law has of `width`.
template <typename LogPriorAt>
double integral_along(const LogPriorAt& log_prior_at, TouchedVector z, double width, int k,
                      double low, double high) {
  constexpr int kSteps = 400000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    z[k] = low + (i + 0.5) * (high - low) / kSteps;
    sum += std::exp(log_prior_at(z));
  }
  return sum * (high - low) / kSteps / (width * std::sqrt(2.0 * kPi));
}

/// Integral over coordinate k of the density of parts touched there. The size is the expected one:
/// for all sizes together the density is a product.
double mass_along(CurveClass curve_class, TouchedAt at, const TouchedVector& centre, int k,
                  double low, double high) {
  const auto log_prior_of = [&](TouchedVector z) {
    if (k > 0) {
      z[0] = expected_log_length(curve_class, at, z);
    }
    return log_prior_touched_at(curve_class, at, z);
  };
  TouchedVector start = centre;
  start[0] = expected_log_length(curve_class, at, start);
  return integral_along(log_prior_of, start, prior_widths({curve_class}, start)[k], k, low, high);
}

/// Cauchy's tails hold 2 / (pi kFar) beyond kFar scales.
constexpr double kFar = 2000.0;
constexpr double kTail = 2.0 * 2.0 / (3.14 * kFar) + 1e-4;

TEST(TouchedCoordinates, EveryFactorOfThePriorIsADensity) {
  const double log_size = 0.5 * std::log(20.0);
  const TouchedVector centre = TouchedVector::Zero();
  const auto mass = [&](CurveClass curve_class, int k, double far) {
    return mass_along(curve_class, TouchedAt::Bend, centre, k, -far, far);
  };
  EXPECT_NEAR(mass(CurveClass::Circle, 0, 40.0), 1.0, 1e-6);
  EXPECT_NEAR(mass(CurveClass::Parabola, 0, 40.0), 1.0, 1e-6);
  EXPECT_NEAR(mass(CurveClass::Parabola, 1, kFar), 1.0, kTail);
  EXPECT_NEAR(mass(CurveClass::CubicSpline, 0, 40.0), 1.0, 1e-6);
  for (int k = 1; k < 4; ++k) {
    EXPECT_NEAR(mass(CurveClass::CubicSpline, k, kFar), 1.0, kTail) << k;
  }
  const Chart arc{CurveClass::CubicSpline, true};
  const auto of_arc = [&](const TouchedVector& z) { return log_prior(arc, z); };
  for (int k = 0; k < 4; ++k) {
    const double width = prior_widths(arc, centre)[k];
    EXPECT_NEAR(integral_along(of_arc, centre, width, k, -kFar, kFar), 1.0, kTail) << k;
  }
  // Cubical parabola: half for either sign of a; a place and the one opposite are the same curve.
  EXPECT_NEAR(mass(CurveClass::CubicalParabola, 0, 40.0), 0.5, 1e-6);
  EXPECT_NEAR(mass(CurveClass::CubicalParabola, 1, kFar), 1.0, kTail);
  EXPECT_NEAR(mass(CurveClass::CubicalParabola, 2, kFar), 2.0, 2.0 * kTail);
  // Of a hyperbola's tip m > 0, Cauchy's about 1.
  TouchedVector tip = centre;
  tip[1] = 1.0;
  EXPECT_NEAR(mass_along(CurveClass::Hyperbola, TouchedAt::Bend, tip, 0, -40.0, 40.0), 1.0, 1e-6);
  EXPECT_NEAR(mass_along(CurveClass::Hyperbola, TouchedAt::Bend, tip, 1, 0.0, kFar), 1.0, kTail);
  EXPECT_NEAR(mass_along(CurveClass::Hyperbola, TouchedAt::Bend, tip, 2, -kFar, kFar), 1.0, kTail);
  // Ellipse: m over (0, 1); the size is half the diagonal; half a turn of directions is all of
  // them, whatever the ellipse. The perimeter is Ramanujan's.
  for (const double m : {0.01, 0.3, 0.99, 1.0}) {
    TouchedVector ellipse = TouchedVector::Zero();
    ellipse.head<2>() << log_size + std::log(m / std::sqrt(1.0 + m)), m;
    EXPECT_NEAR(log_prior_touched_at(CurveClass::Ellipse, TouchedAt::Bend, ellipse), 0.0, 1e-14)
        << m;
    EXPECT_NEAR(mass_along(CurveClass::Ellipse, TouchedAt::Bend, ellipse, 0, -40.0, 40.0), 1.0,
                1e-6)
        << m;
    EXPECT_NEAR(mass_along(CurveClass::Ellipse, TouchedAt::Bend, ellipse, 2, 0.0, kPi), 1.0, 4e-4)
        << m;
  }
  EXPECT_NEAR(prior_widths({CurveClass::Ellipse}, TouchedVector::Ones())[1] * std::sqrt(2.0 * kPi),
              1.0, 1e-14);
}

/// Slope and place are independent for all sizes together, so that the integral along one is its
/// own share of what the heights at 0 are.
TEST(TouchedCoordinates, ArmsAreDensities) {
  const TouchedVector centre = TouchedVector::Zero();
  for (const CurveClass curve_class : {CurveClass::Parabola, CurveClass::CubicalParabola}) {
    // Along each coordinate at the centre, over the height there: the product is the whole mass.
    TouchedVector z = centre;
    z[0] = expected_log_length(curve_class, TouchedAt::Arms, z);
    const int own = shape_coordinates(curve_class);
    double mass = std::exp(log_prior_touched_at(curve_class, TouchedAt::Arms, z) * (1.0 - own));
    for (int k = 0; k < own; ++k) {
      const double far = k == 0 ? 40.0 : kFar;
      mass *= mass_along(curve_class, TouchedAt::Arms, centre, k, -far, far);
    }
    EXPECT_NEAR(mass, 1.0, 3.0 * kTail) << name_of(curve_class);
  }
}

/// Of an ellipse's tip; m as the square of the eccentricity, 1 - m.
TEST(TouchedCoordinates, TipsOfEllipsesAreADensity) {
  for (const double m : {0.01, 0.3, 0.99}) {
    TouchedVector tip = TouchedVector::Zero();
    tip.segment<2>(1) << m, 0.5 * kPi;
    const auto mass = [&](double low, double high) {
      return mass_along(CurveClass::Ellipse, TouchedAt::Arms, tip, 2, low, high) /
             (2.0 * (1.0 - m));
    };
    EXPECT_NEAR(mass(0.0, kPi), 1.0, 1e-4) << m;
    // As of a parabola half are touched where the slope against the tip is above 3.
    EXPECT_NEAR(mass(std::atan2(1.0, 3.0), std::atan2(1.0, -3.0)), 0.5, 1e-4) << m;
    // The size is that of a parabola of this p.
    TouchedVector parabola = TouchedVector::Zero();
    parabola[1] = 2.0;
    tip[2] = std::atan2(1.0, 2.0);
    EXPECT_NEAR(expected_log_length(CurveClass::Ellipse, TouchedAt::Arms, tip),
                expected_log_length(CurveClass::Parabola, TouchedAt::Arms, parabola), 1e-12);
  }
}

/// Half of the places are beyond those where parts end without arms, half of the slopes at the bend
/// are above 1.
TEST(TouchedCoordinates, HalfOfTheArmsAreLong) {
  struct Law {
    CurveClass curve_class;
    int k;
    double middle;
  };
  for (const Law& law :
       {Law{CurveClass::Parabola, 1, 3.0}, Law{CurveClass::CubicalParabola, 1, 1.0},
        Law{CurveClass::CubicalParabola, 2, 1.0}}) {
    const auto mass = [&](double far) {
      return mass_along(law.curve_class, TouchedAt::Arms, TouchedVector::Zero(), law.k, -far, far);
    };
    EXPECT_NEAR(mass(law.middle) / mass(kFar), 0.5, kTail)
        << name_of(law.curve_class) << ' ' << law.k;
  }
}

/// A part's size reaches as far as it is touched: half the diagonal of the box of the curve from
/// one end to the other. Shear of 0.75 of the cube makes up for most of it: then the box is as
/// little as a fifth.
TEST(TouchedCoordinates, APartReachesAsFarAsItIsTouched) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 100; ++i) {
    for (const CurveClass curve_class : {CurveClass::Parabola, CurveClass::CubicalParabola}) {
      TouchedVector z = TouchedVector::Zero();
      z[1] = test::uniform(rng, -3.0, 3.0);
      z[place_coordinate(curve_class)] = test::uniform(rng, -8.0, 8.0);
      z[0] = expected_log_length(curve_class, TouchedAt::Arms, z);
      const auto shape = shape_at({curve_class}, z, {Eigen::Vector3d::Ones(), 0.0});
      const auto curve = make_curve(curve_class, shape->values);
      // The end is as far again as that of a part without arms.
      const double without = curve_class == CurveClass::Parabola ? 3.0 : std::exp(z[0]);
      const double end = std::hypot(without, shape->t);
      Vec2 low = position(*curve, end);
      Vec2 high = low;
      for (double t = -end; t <= end; t += 0.01 * end) {
        low = low.cwiseMin(position(*curve, t));
        high = high.cwiseMax(position(*curve, t));
      }
      const double size = 0.5 * (high - low).norm();
      EXPECT_LT(size, std::sqrt(2.0) * std::sqrt(20.0)) << name_of(curve_class);
      EXPECT_GT(size, std::sqrt(20.0) / 5.0) << name_of(curve_class);
    }
  }
}

/// Of wedges the size is half the distance c of the foci, the place y / b, and b^2 / c^2 uniform.
TEST(TouchedCoordinates, WedgesAreADensity) {
  constexpr auto kHyperbola = CurveClass::Hyperbola;
  const TouchedVector widths = prior_widths({kHyperbola}, TouchedVector::Zero());
  const auto of_wedge = [](const TouchedVector& z) {
    return log_prior_touched_at(kHyperbola, TouchedAt::Arms, z);
  };
  for (const double square : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99}) {
    const double m = square / (1.0 - square);
    TouchedVector wedge = TouchedVector::Zero();
    wedge[1] = m;
    wedge[0] = 0.5 * std::log(20.0) + std::log(m / std::sqrt(1.0 + m));  // p of that size
    EXPECT_NEAR(expected_log_length(kHyperbola, TouchedAt::Arms, wedge), wedge[0], 1e-14) << m;
    const double at_size = of_wedge(wedge);
    const auto by_size = [&](const TouchedVector& z) { return of_wedge(z) - at_size; };
    EXPECT_NEAR(integral_along(by_size, wedge, widths[0], 0, -40.0, 40.0), 1.0, 1e-6) << m;
    const double far = kFar / std::sqrt(square);
    const double by_m = integral_along(of_wedge, wedge, widths[2], 2, -far, far) /
                        (widths[1] * std::sqrt(2.0 * kPi));
    EXPECT_NEAR(by_m * std::pow(1.0 - square, -2), 1.0, kTail) << m;
  }
}

/// A tenth of the prior is of arms.
TEST(TouchedCoordinates, ThePriorIsBendsAndArms) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Parabola,
                                       CurveClass::Hyperbola, CurveClass::CubicalParabola}) {
    const TouchedVector z = coordinates_of({curve_class}, random_shape(curve_class, rng));
    const double bend = std::exp(log_prior_touched_at(curve_class, TouchedAt::Bend, z));
    const double arms = std::exp(log_prior_touched_at(curve_class, TouchedAt::Arms, z));
    EXPECT_NEAR(log_prior({curve_class}, z), std::log(0.9 * bend + 0.1 * arms), 1e-12)
        << name_of(curve_class);
  }
}

/// Places of an ellipse are as probable as their share of the perimeter.
TEST(TouchedCoordinates, AnEllipseIsTouchedEvenlyByArcLength) {
  const Chart chart{CurveClass::Ellipse};
  for (const double m : {0.003, 0.2, 0.9}) {
    const Ellipse ellipse{1.0, std::sqrt(m)};
    const auto log_density_at = [&](double t) {
      const TouchedVector z = coordinates_of(chart, {{ellipse.a, ellipse.b, 0.0}, t});
      return log_prior_touched_at(CurveClass::Ellipse, TouchedAt::Bend, z) -
             std::log(prior_widths(chart, z)[2]);
    };
    for (double t = 0.1; t < 1.5; t += 0.2) {
      // By direction arc length runs as the radius of curvature.
      const double ratio = std::log(std::abs(ellipse.geometry(0.05).kappa)) -
                           std::log(std::abs(ellipse.geometry(t).kappa));
      EXPECT_NEAR(log_density_at(t) - log_density_at(0.05), ratio, 1e-12) << m << ' ' << t;
    }
  }
}

TEST_P(TouchedCoordinatesOf, DerivativesOfThePriorAreThoseOfDifferences) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 100; ++i) {
    TouchedShape shape = random_shape(GetParam().curve_class, rng);
    const TouchedVector z = coordinates_of(GetParam(), shape);
    const TouchedVector gradient = log_prior_gradient(GetParam(), z);
    for (int k = 0; k < shape_coordinates(GetParam().curve_class); ++k) {
      constexpr double kStep = 1e-6;
      TouchedVector ahead = z;
      TouchedVector behind = z;
      ahead[k] += kStep;
      behind[k] -= kStep;
      const double difference =
          (log_prior(GetParam(), ahead) - log_prior(GetParam(), behind)) / (2.0 * kStep);
      // Rounding over the step, and third derivatives of up to its power -3 by m.
      const bool has_m = GetParam().curve_class == CurveClass::Ellipse ||
                         GetParam().curve_class == CurveClass::Hyperbola;
      const double third = has_m ? std::pow(z[1], -3) : 1.0;
      EXPECT_NEAR(gradient[k], difference, 1e-8 + 100.0 * kStep * kStep * third) << i << ' ' << k;
    }
  }
}

TEST_P(TouchedCoordinatesOf, DerivativesOfChiSquareAreThoseOfDifferences) {
  std::mt19937_64 rng = test::test_rng();
  int compared = 0;
  for (int i = 0; i < 20; ++i) {
    test::SceneOptions options;
    options.patches = 2;
    options.sigma_over_size = 1e-3;
    const test::Scene scene = test::random_scene(GetParam().curve_class, options, rng);
    FitData data = test::fit_data(scene, scene.sigma_m);
    CanonicalFit truth;
    truth.shape = {GetParam().curve_class, scene.values};
    truth.world_T_curve = scene.world_T_curve;
    for (const auto& patch : scene.t) {
      for (const double t : patch) {
        truth.points.push_back({t, 0.0, Vec2::Zero()});
      }
    }
    auto touch = touch_of(truth, data);
    ASSERT_TRUE(touch.has_value());
    touch->as_arc = GetParam().as_arc;
    const auto curve = curve_at(*touch, truth, data);
    ASSERT_TRUE(curve.has_value());
    for (int k = 0; k < shape_coordinates(GetParam().curve_class) + 2; ++k) {
      constexpr double kStep = 1e-6;
      TouchedVector ahead = curve->z;
      TouchedVector behind = curve->z;
      ahead[k] += kStep;
      behind[k] -= kStep;
      const auto f = curve_at(*touch, ahead, *curve, data);
      const auto g = curve_at(*touch, behind, *curve, data);
      ASSERT_TRUE(f && g);
      const double difference = (f->chi2 - g->chi2) / (2.0 * kStep) * curve->widths[k];
      // Third derivatives, and residuals that leave the curve's own bend out: relative to the
      // largest slope that a residual per point could have.
      const double scale = curve->root.row(k).norm() * std::sqrt(curve->chi2);
      EXPECT_NEAR(2.0 * curve->gradient[k], difference, 1e-4 * scale) << k;
      ++compared;
    }
  }
  EXPECT_GT(compared, 0);
}

// --- The spline as an arc

TEST(ArcCoordinates, AreTheTermsOfTheSeriesAlongTheTangent) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 100; ++i) {
    const TouchedShape shape = random_shape(CurveClass::CubicSpline, rng);
    const Curve spline = make_curve(CurveClass::CubicSpline, shape.values).value();
    const CurveDerivatives at = derivatives(spline, shape.t);
    const Vec2 tangent = at.first.normalized();
    const ArcCoordinates z = arc_coordinates_of(shape);
    for (const double s : {-1.0, 0.3, 2.0}) {
      const Vec2 away = position(spline, shape.t + s / at.first.norm()) - at.position;
      const Vec2 of_series =
          s * Vec2::UnitX() + s * s / 2.0 * z.head<2>() + s * s * s / 6.0 * z.tail<2>();
      EXPECT_NEAR(away.dot(tangent), of_series.x(), 1e-12 * (1.0 + z.norm()));
      EXPECT_NEAR(cross(tangent, away), of_series.y(), 1e-12 * (1.0 + z.norm()));
    }
  }
}

TEST(ArcCoordinates, EndAtParabolasAndCubicalParabolas) {
  EXPECT_FALSE(spline_at({0.3, 0.2, 0.0, 0.0}).has_value());
  // The second derivative along the third: x would be a straight function of t.
  EXPECT_FALSE(spline_at({0.2, 0.4, 0.1, 0.2}).has_value());
  EXPECT_TRUE(spline_at({0.2, -0.4, 0.1, 0.2}).has_value() !=
              spline_at({-0.2, 0.4, 0.1, 0.2}).has_value())
      << "one of both senses of travel";
}

std::vector<Chart> all_charts() {
  std::vector<Chart> charts(kCurveClasses.size());
  std::transform(kCurveClasses.begin(), kCurveClasses.end(), charts.begin(),
                 [](CurveClass curve_class) { return Chart{curve_class}; });
  charts.push_back({CurveClass::CubicSpline, true});
  return charts;
}

INSTANTIATE_TEST_SUITE_P(AllClasses, TouchedCoordinatesOf, testing::ValuesIn(all_charts()),
                         [](const auto& param_info) {
                           return std::string(name_of(param_info.param.curve_class)) +
                                  (param_info.param.as_arc ? "_as_arc" : "");
                         });

}  // namespace
}  // namespace palpate
