// Properties that every invariant and fit must have, on thousands of random curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/invariants/conic_line.h"
#include "core/invariants/signature_fit/conic_start.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "tests/support/canonical_points.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::PlacedCurve;

/// The fit of the class from local geometry alone, without a given start.
SemiSignatureFit fit_class(CurveClass curve_class, std::span<const MeasuredGeometry> points,
                           const Eigen::Vector3d& conic_start = Eigen::Vector3d::Zero()) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return fit_cubical_parabola(points);
    case CurveClass::SemiCubicalParabola:
      return fit_semi_cubical_parabola(points);
    case CurveClass::CubicSpline:
      return fit_cubic_spline(points);
    default:
      return fit_semi_signature(curve_class, points, conic_start,
                                conic_orientation(curve_class, conic_start, points));
  }
}

/// Largest relative deviation of the parameters that the class has.
double deviation(const PlacedCurve& curve, const Eigen::Vector3d& parameters) {
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (curve.parameters[i] != 0.0) {
      worst = std::max(worst, std::abs(parameters[i] / curve.parameters[i] - 1.0));
    }
  }
  return worst;
}

/// How far rounding of exact inputs can move the parameters, summed over the points: ten standard
/// deviations of the fit for the noise of 1e-12 that stands for rounding.
double tolerance(const PlacedCurve& curve, const SemiSignatureFit& fit) {
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (curve.parameters[i] != 0.0) {
      worst = std::max(worst, std::sqrt(fit.covariance(i, i)) / std::abs(curve.parameters[i]));
    }
  }
  return 10.0 * worst;
}

class EveryClass : public testing::TestWithParam<CurveClass> {};

INSTANTIATE_TEST_SUITE_P(Invariants, EveryClass,
                         testing::ValuesIn(test::invariant_classes().begin(),
                                           test::invariant_classes().end()),
                         [](const auto& param_info) {
                           return std::string(name_of(param_info.param));
                         });

TEST_P(EveryClass, ShapeIsRecoveredAtAnyPoseAndDirectionOfTravel) {
  auto rng = test::test_rng();
  const int cases = test::stress_count(500);
  int recovered = 0;
  for (int i = 0; i < cases; ++i) {
    const PlacedCurve curve = test::random_curve(GetParam(), rng);
    const auto points =
        test::measured(test::exact_points(curve, test::random_places(curve, 5, rng), rng));
    const auto fit = fit_class(GetParam(), points, curve.parameters);
    recovered += fit.status == InvariantStatus::Ok &&
                         deviation(curve, fit.parameters) <= tolerance(curve, fit)
                     ? 1
                     : 0;
  }
  if (!test::counts_tell()) {
    return;
  }
  // Starts from pairs of points fail if all pairs are badly conditioned.
  EXPECT_GE(recovered, cases * 99 / 100);
}

TEST_P(EveryClass, ScaleIsCarriedThroughFrom1e6thTo1e6) {
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(50); ++i) {
    const PlacedCurve curve = test::random_curve(GetParam(), rng);
    const auto places = test::random_places(curve, 5, rng);
    auto unit_rng = rng;
    const auto unit_fit = fit_class(
        GetParam(), test::measured(test::exact_points(curve, places, unit_rng)), curve.parameters);
    for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
      auto same_rng = rng;
      // Exact data of the same curve in another unit, with t scaled accordingly.
      auto points = test::measured(test::exact_points(curve, places, same_rng));
      for (MeasuredGeometry& point : points) {
        point = in_units_of(point, 1.0 / factor);
      }
      const PlacedCurve scaled = test::scaled(curve, factor);
      const auto fit = fit_class(GetParam(), points, scaled.parameters);
      ASSERT_EQ(fit.status, unit_fit.status) << factor;
      if (fit.status == InvariantStatus::Ok) {
        EXPECT_LE(deviation(scaled, fit.parameters),
                  deviation(curve, unit_fit.parameters) + tolerance(scaled, fit))
            << factor;
      }
    }
  }
}

TEST_P(EveryClass, OrderOfThePointsDoesNotMatter) {
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(50); ++i) {
    const PlacedCurve curve = test::random_curve(GetParam(), rng);
    auto points =
        test::measured(test::exact_points(curve, test::random_places(curve, 5, rng), rng));
    const auto fit = fit_class(GetParam(), points, curve.parameters);
    std::shuffle(points.begin(), points.end(), rng);
    const auto again = fit_class(GetParam(), points, curve.parameters);
    ASSERT_EQ(fit.status, again.status);
    if (fit.status == InvariantStatus::Ok) {
      EXPECT_LE(deviation(curve, again.parameters), tolerance(curve, again));
    }
  }
}

TEST_P(EveryClass, RotationIsCarriedIntoTheOrientation) {
  auto rng = test::test_rng();
  const double symmetry = pose_symmetry(GetParam());
  for (int i = 0; i < test::stress_count(50); ++i) {
    const PlacedCurve curve = test::random_curve(GetParam(), rng);
    auto points =
        test::measured(test::exact_points(curve, test::random_places(curve, 5, rng), rng));
    const auto fit = fit_class(GetParam(), points, curve.parameters);
    // Well beyond pi, and with whole turns between the points: tangent angles need no unwrapping.
    int turns = 0;
    for (MeasuredGeometry& point : points) {
      point.tangent_angle += 7.5 + 2.0 * kPi * (turns++ % 3);
    }
    const auto turned = fit_class(GetParam(), points, curve.parameters);
    ASSERT_EQ(fit.status, turned.status);
    if (fit.status == InvariantStatus::Ok) {
      const double sd = std::sqrt(turned.covariance(GetParam() == CurveClass::CubicSpline ? 3
                                                    : GetParam() == CurveClass::Parabola  ? 1
                                                                                          : 2,
                                                    GetParam() == CurveClass::CubicSpline ? 3
                                                    : GetParam() == CurveClass::Parabola  ? 1
                                                                                          : 2));
      EXPECT_NEAR(std::sin(0.5 * symmetry * (turned.orientation - fit.orientation - 7.5)), 0.0,
                  20.0 * sd);
      EXPECT_LE(deviation(curve, turned.parameters), tolerance(curve, turned));
    }
  }
}

TEST(ConicLine, IsUnchangedByTravelAndOrderAndScales) {
  auto rng = test::test_rng();
  for (const CurveClass curve_class :
       {CurveClass::Ellipse, CurveClass::Parabola, CurveClass::Hyperbola}) {
    for (int i = 0; i < test::stress_count(300); ++i) {
      const PlacedCurve curve = test::random_curve(curve_class, rng);
      auto points =
          test::measured(test::exact_points(curve, test::random_places(curve, 6, rng), rng));
      const ConicLine line = fit_conic_line(points);
      ASSERT_EQ(line.status, InvariantStatus::Ok);
      std::reverse(points.begin(), points.end());
      for (MeasuredGeometry& point : points) {
        point = in_units_of(point, 1e6);
      }
      const ConicLine other = fit_conic_line(points);
      ASSERT_EQ(other.status, InvariantStatus::Ok);
      // Ic1 scales with length^(-4/3), Ic2 with length^(-2/3).
      const double f1 = std::pow(1e6, 4.0 / 3.0);
      const double f2 = std::pow(1e6, 2.0 / 3.0);
      EXPECT_NEAR(other.ic1 / f1, line.ic1, 4.0 * std::sqrt(line.covariance(0, 0)));
      EXPECT_NEAR(other.ic2 / f2, line.ic2, 4.0 * std::sqrt(line.covariance(1, 1)));
    }
  }
}

}  // namespace
}  // namespace palpate
