#include "core/invariants/conic_invariants.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/invariants/conic_line.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/constant_curvature.h"
#include "core/invariants/parabola_invariant.h"
#include "tests/unit/invariants/reference_geometry.h"

namespace palpate {
namespace {

using test::kEpsilon;
using test::measured;
using test::ReferenceCurve;

/// Roundings on the way from (kappa, kappa_s) to an invariant of two points: two cube roots, two
/// Ip of six operations each, a difference, a quotient, a product.
constexpr double kOperations = 8.0;

const std::array kConics = {CurveClass::Ellipse, CurveClass::Parabola, CurveClass::Hyperbola};

Eigen::Vector2d true_invariants(const ReferenceCurve& curve) {
  const double ab = curve.a * curve.b;
  switch (curve.curve_class) {
    case CurveClass::Ellipse:
      return {std::pow(ab, -2.0 / 3.0),
              (curve.a * curve.a + curve.b * curve.b) * std::pow(ab, -4.0 / 3.0)};
    case CurveClass::Hyperbola:
      return {-std::pow(ab, -2.0 / 3.0),
              (curve.a * curve.a - curve.b * curve.b) * std::pow(ab, -4.0 / 3.0)};
    default:
      return {0.0, std::pow(2.0 * curve.a, -2.0 / 3.0)};
  }
}

TEST(ParabolaInvariant, AgreesWithTheReferenceOnEveryCurve) {
  int compared = 0;
  for (const ReferenceCurve& curve : test::reference_curves()) {
    for (const auto& point : curve.points) {
      if (point.ip && std::isfinite(*point.ip)) {
        const Eigen::Vector2d inputs(point.kappa, point.kappa_s);
        const auto ip = propagate<1, 2>(
            inputs, [](const auto& x) { return std::array{parabola_invariant(x[0], x[1])}; });
        const double bound = test::conditioning_bound(ip, inputs, 4.0)[0];
        EXPECT_NEAR(ip.value[0], *point.ip, bound) << name_of(curve.curve_class) << " " << point.t;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 350);
}

TEST(ParabolaInvariant, IsConstantAlongAParabola) {
  for (const ReferenceCurve& curve : test::reference_curves_of(CurveClass::Parabola)) {
    const double expected = std::pow(2.0 * curve.a, -2.0 / 3.0);
    for (const auto& point : curve.points) {
      // d ln Ip / d ln kappa lies between -10/3 and 2/3, d ln Ip / d ln kappa_s between 0 and 2.
      EXPECT_NEAR(parabola_invariant(point.kappa, point.kappa_s) / expected, 1.0, 16.0 * kEpsilon)
          << "a " << curve.a << " t " << point.t;
    }
  }
}

TEST(ConicInvariants, AreConstantOverAllPairsOfAllConics) {
  int within_1e10 = 0;
  int pairs = 0;
  for (const CurveClass curve_class : kConics) {
    for (const ReferenceCurve& curve : test::reference_curves_of(curve_class)) {
      const Eigen::Vector2d expected = true_invariants(curve);
      for (std::size_t i = 0; i < curve.points.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          const auto result =
              conic_invariants(measured(curve.points[i]), measured(curve.points[j]));
          if (result.status == InvariantStatus::PointsTooAlike) {
            continue;
          }
          ASSERT_EQ(result.status, InvariantStatus::Ok);
          const Eigen::Vector4d inputs(curve.points[i].kappa, curve.points[i].kappa_s,
                                       curve.points[j].kappa, curve.points[j].kappa_s);
          const auto linear = propagate<2, 4>(inputs, [](const auto& x) {
            auto out = std::array{x[0], x[0]};
            conic_pair(x[0], x[1], x[2], x[3], out[0], out[1]);
            return out;
          });
          const Eigen::Vector2d bound = test::conditioning_bound(linear, inputs, kOperations);
          EXPECT_NEAR(result.ic1, expected[0], bound[0])
              << name_of(curve_class) << " " << curve.a << " " << curve.b << " t "
              << curve.points[i].t << " " << curve.points[j].t;
          EXPECT_NEAR(result.ic2, expected[1], bound[1]);
          ++pairs;
          within_1e10 += std::abs(result.ic2 / expected[1] - 1.0) < 1e-10 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(pairs, 1000);
  EXPECT_GT(within_1e10, pairs * 3 / 4);  // the rest: points whose curvatures hardly differ
}

TEST(ConicLine, RecoversTheInvariantsOfEveryConicFromAllItsPoints) {
  for (const CurveClass curve_class : kConics) {
    for (const ReferenceCurve& curve : test::reference_curves_of(curve_class)) {
      const Eigen::Vector2d expected = true_invariants(curve);
      const ConicLine line = fit_conic_line(measured(curve));
      ASSERT_EQ(line.status, InvariantStatus::Ok) << describe(line.status);
      // The fit's own standard deviations are those of 8 roundings an abscissa and ordinate.
      EXPECT_NEAR(line.ic1, expected[0], 4.0 * std::sqrt(line.covariance(0, 0)));
      EXPECT_NEAR(line.ic2, expected[1], 4.0 * std::sqrt(line.covariance(1, 1)));
      EXPECT_LT(line.chi2, 4.0 * line.dof);
      EXPECT_EQ(line.dof, static_cast<int>(curve.points.size()) - 2);
    }
  }
}

TEST(ConicParameters, AreRecoveredFromTheLineTo1e9) {
  for (const CurveClass curve_class : kConics) {
    for (const ReferenceCurve& curve : test::reference_curves_of(curve_class)) {
      const ConicLine line = fit_conic_line(measured(curve));
      const ConicParameters parameters =
          curve_class == CurveClass::Ellipse
              ? ellipse_parameters(line.ic1, line.ic2, line.covariance)
          : curve_class == CurveClass::Hyperbola
              ? hyperbola_parameters(line.ic1, line.ic2, line.covariance)
              : parabola_parameters(line.ip_mean, line.ip_variance);
      ASSERT_EQ(parameters.status, InvariantStatus::Ok);
      // a/b = 1 + 1e-7: the spread of u is 1e-7, so that Ic1 keeps nine digits and no more.
      const double tolerance = curve.a == 1.0000001 ? 3e-9 : 1e-9;
      EXPECT_NEAR(parameters.a / curve.a, 1.0, tolerance) << name_of(curve_class) << " " << curve.a;
      if (curve.b != 0.0) {
        EXPECT_NEAR(parameters.b / curve.b, 1.0, tolerance)
            << name_of(curve_class) << " " << curve.b;
      }
    }
  }
}

TEST(ConicParameters, InvertTheInvariantsExactly) {
  const Eigen::Matrix2d none = Eigen::Matrix2d::Zero();
  for (const double b : {1.0, 0.5, 0.01}) {
    const double ic1 = std::pow(b, -2.0 / 3.0);
    const auto ellipse = ellipse_parameters(ic1, (1.0 + b * b) * std::pow(b, -4.0 / 3.0), none);
    EXPECT_NEAR(ellipse.a, 1.0, 1e-7 * (b == 1.0) + 8 * kEpsilon);  // double root at the circle
    EXPECT_NEAR(ellipse.b / b, 1.0, 1e-7 * (b == 1.0) + 8 * kEpsilon);
    const auto wide = hyperbola_parameters(-ic1, (1.0 - b * b) * std::pow(b, -4.0 / 3.0), none);
    EXPECT_NEAR(wide.a, 1.0, 8 * kEpsilon);
    EXPECT_NEAR(wide.b / b, 1.0, 8 * kEpsilon);
    const auto tall = hyperbola_parameters(-ic1, (b * b - 1.0) * std::pow(b, -4.0 / 3.0), none);
    EXPECT_NEAR(tall.a / b, 1.0, 8 * kEpsilon);
    EXPECT_NEAR(tall.b, 1.0, 8 * kEpsilon);
  }
}

TEST(ConicParameters, RefuseTheOtherClasses) {
  const Eigen::Matrix2d none = Eigen::Matrix2d::Zero();
  EXPECT_EQ(ellipse_parameters(-1.0, 1.0, none).status, InvariantStatus::NotThisClass);
  EXPECT_EQ(ellipse_parameters(1.0, 1.0, none).status, InvariantStatus::NotThisClass);
  EXPECT_EQ(hyperbola_parameters(1.0, 1.0, none).status, InvariantStatus::NotThisClass);
  EXPECT_EQ(parabola_parameters(-1.0, 0.0).status, InvariantStatus::NotThisClass);
  EXPECT_EQ(parabola_parameters(std::nan(""), 0.0).status, InvariantStatus::NotFinite);
}

TEST(ConstantCurvature, KnowsACircleAndALine) {
  std::vector<MeasuredGeometry> points(4);
  EXPECT_EQ(fit_constant_curvature(points).line_chi2, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].patch = static_cast<int>(i);
    points[i].kappa = i % 2 == 0 ? 40.0 : -40.0;  // travelled both ways
  }
  const ConstantCurvature circle = fit_constant_curvature(points);
  EXPECT_DOUBLE_EQ(circle.kappa, 40.0);
  EXPECT_LT(circle.circle_chi2, 1.0);
  EXPECT_EQ(circle.circle_dof, 7);
  EXPECT_GT(circle.line_chi2, 1e20);
}

}  // namespace
}  // namespace palpate
