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

/// Integral over coordinate k of the prior's density, the others at the centre.
double mass_along(Chart chart, const TouchedVector& centre, int k, double low, double high) {
  const double at_centre = log_prior(chart, centre);
  return integral_along([&](const TouchedVector& z) { return log_prior(chart, z) - at_centre; },
                        centre, prior_widths(chart, centre)[k], k, low, high);
}

TEST(TouchedCoordinates, EveryFactorOfThePriorIsADensity) {
  // Cauchy's tails hold 2 / (pi kFar) beyond kFar scales.
  constexpr double kFar = 2000.0;
  constexpr double kTail = 2.0 * 2.0 / (3.14 * kFar) + 1e-4;
  const double log_size = 0.5 * std::log(20.0);
  const auto centre_of = [&](CurveClass curve_class) {
    TouchedVector z = TouchedVector::Zero();
    z[0] = log_size + log_length_over_size(curve_class);
    return z;
  };
  TouchedVector z = centre_of(CurveClass::Circle);
  EXPECT_NEAR(mass_along({CurveClass::Circle}, z, 0, -40, 40), 1.0, 1e-6);
  z = centre_of(CurveClass::Parabola);
  EXPECT_NEAR(mass_along({CurveClass::Parabola}, z, 0, -40, 40), 1.0, 1e-6);
  EXPECT_NEAR(mass_along({CurveClass::Parabola}, z, 1, -kFar, kFar), 1.0, kTail);
  const TouchedVector spline = centre_of(CurveClass::CubicSpline);
  EXPECT_NEAR(mass_along({CurveClass::CubicSpline}, spline, 0, -40, 40), 1.0, 1e-6);
  EXPECT_NEAR(mass_along({CurveClass::CubicSpline}, spline, 1, -kFar, kFar), 1.0, kTail);
  EXPECT_NEAR(mass_along({CurveClass::CubicSpline}, spline, 2, -kFar, kFar), 1.0, kTail);
  EXPECT_NEAR(mass_along({CurveClass::CubicSpline}, spline, 3, -kFar, kFar), 1.0, kTail);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(mass_along({CurveClass::CubicSpline, true}, TouchedVector::Zero(), k, -kFar, kFar),
                1.0, kTail);
  }
  z = centre_of(CurveClass::CubicalParabola);
  // Cubical parabola: half for either sign of a; a place and the one opposite are the same curve.
  EXPECT_NEAR(mass_along({CurveClass::CubicalParabola}, z, 0, -40, 40), 0.5, 1e-6);
  EXPECT_NEAR(mass_along({CurveClass::CubicalParabola}, z, 1, -kFar, kFar), 1.0, kTail);
  EXPECT_NEAR(mass_along({CurveClass::CubicalParabola}, z, 2, -kFar, kFar), 2.0, 2.0 * kTail);
  // Ellipse: m over (0, 1); the size is half the diagonal; half a turn of directions is all of
  // them, whatever the ellipse. The perimeter is Ramanujan's.
  for (const double m : {0.01, 0.3, 0.99, 1.0}) {
    TouchedVector ellipse = TouchedVector::Zero();
    ellipse.head<2>() << log_size + std::log(m / std::sqrt(1.0 + m)), m;
    EXPECT_NEAR(log_prior({CurveClass::Ellipse}, ellipse), 0.0, 1e-14) << m;
    EXPECT_NEAR(mass_along({CurveClass::Ellipse}, ellipse, 0, -40.0, 40.0), 1.0, 1e-6) << m;
    EXPECT_NEAR(mass_along({CurveClass::Ellipse}, ellipse, 2, 0.0, kPi), 1.0, 4e-4) << m;
  }
  EXPECT_NEAR(prior_widths({CurveClass::Ellipse}, TouchedVector::Ones())[1] * std::sqrt(2.0 * kPi),
              1.0, 1e-14);
}

/// Both halves of the hyperbola's prior, of which the prior is the mean.
TEST(TouchedCoordinates, BothHalvesOfTheHyperbolasPriorAreDensities) {
  constexpr double kFar = 2000.0;
  constexpr double kTail = 2.0 * 2.0 / (3.14 * kFar) + 1e-4;
  const TouchedVector widths = prior_widths({CurveClass::Hyperbola}, TouchedVector::Zero());
  const auto of_tip = [](const TouchedVector& z) {
    return log_prior_of_half(HyperbolaHalf::Tip, z);
  };
  const auto of_wedge = [](const TouchedVector& z) {
    return log_prior_of_half(HyperbolaHalf::Wedge, z);
  };
  TouchedVector tip = TouchedVector::Zero();
  tip[1] = 1.0;
  tip[0] = expected_log_length(HyperbolaHalf::Tip, tip);
  EXPECT_EQ(of_tip(tip), 0.0);
  EXPECT_NEAR(integral_along(of_tip, tip, widths[0], 0, -40.0, 40.0), 1.0, 1e-6);
  EXPECT_NEAR(integral_along(of_tip, tip, widths[1], 1, 0.0, kFar), 1.0, kTail);
  EXPECT_NEAR(integral_along(of_tip, tip, widths[2], 2, -kFar, kFar), 1.0, kTail);
  // Of wedges the size is half the distance c of the foci, the place y / b, and b^2 / c^2 uniform.
  for (const double square : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99}) {
    const double m = square / (1.0 - square);
    TouchedVector wedge = TouchedVector::Zero();
    wedge[1] = m;
    wedge[0] = 0.5 * std::log(20.0) + std::log(m / std::sqrt(1.0 + m));  // p of that size
    EXPECT_NEAR(expected_log_length(HyperbolaHalf::Wedge, wedge), wedge[0], 1e-14) << m;
    const double at_size = of_wedge(wedge);
    const auto by_size = [&](const TouchedVector& z) { return of_wedge(z) - at_size; };
    EXPECT_NEAR(integral_along(by_size, wedge, widths[0], 0, -40.0, 40.0), 1.0, 1e-6) << m;
    const double far = kFar / std::sqrt(square);
    const double by_m = integral_along(of_wedge, wedge, widths[2], 2, -far, far) /
                        (widths[1] * std::sqrt(2.0 * kPi));
    EXPECT_NEAR(by_m * std::pow(1.0 - square, -2), 1.0, kTail) << m;
    wedge[2] = 0.3;
    EXPECT_NEAR(log_prior({CurveClass::Hyperbola}, wedge),
                std::log(0.5 * (std::exp(of_tip(wedge)) + std::exp(of_wedge(wedge)))), 1e-13)
        << m;
  }
}

/// Places of an ellipse are as probable as their share of the perimeter.
TEST(TouchedCoordinates, AnEllipseIsTouchedEvenlyByArcLength) {
  const Chart chart{CurveClass::Ellipse};
  for (const double m : {0.003, 0.2, 0.9}) {
    const Ellipse ellipse{1.0, std::sqrt(m)};
    const auto log_density_at = [&](double t) {
      const TouchedVector z = coordinates_of(chart, {{ellipse.a, ellipse.b, 0.0}, t});
      return log_prior(chart, z) - std::log(prior_widths(chart, z)[2]);
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
