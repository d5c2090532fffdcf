// Hard cases of the invariants: each has a name and a defined outcome, and none may be NaN.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/pose2.h"
#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_line.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/constant_curvature.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "tests/support/canonical_points.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::PlacedCurve;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<MeasuredGeometry> points_of(CurveClass curve_class, const Eigen::Vector3d& parameters,
                                        const std::vector<double>& places) {
  std::vector<MeasuredGeometry> points;
  for (const double t : places) {
    points.push_back(measured_geometry(test::exact_estimate({curve_class, parameters, {}}, t),
                                       static_cast<int>(points.size())));
  }
  return points;
}

bool finite(const SemiSignatureFit& fit) {
  return fit.parameters.allFinite() && std::isfinite(fit.orientation) && !std::isnan(fit.chi2) &&
         !fit.covariance.hasNaN();
}

TEST(EqualCurvatures, LeaveAPairUndetermined) {
  const auto points = points_of(CurveClass::Ellipse, {2.0, 1.0, 0.0}, {0.4, kPi - 0.4});
  MeasuredGeometry twin = points[1];
  twin.kappa = points[0].kappa;  // equal to the last digit
  EXPECT_EQ(conic_invariants(points[0], twin).status, InvariantStatus::PointsTooAlike);
}

TEST(EqualCurvatures, LeaveTheLineUndeterminedWithInfiniteVariance) {
  auto points = points_of(CurveClass::Ellipse, {2.0, 1.0, 0.0}, {0.4, kPi - 0.4, kPi + 0.4, -0.4});
  for (MeasuredGeometry& point : points) {
    point.kappa = points[0].kappa;
  }
  const ConicLine line = fit_conic_line(points);
  EXPECT_EQ(line.status, InvariantStatus::PointsTooAlike);
  EXPECT_EQ(line.covariance(0, 0), kInfinity);
  EXPECT_EQ(line.ic1, 0.0);
  EXPECT_NEAR(line.ic2, line.ip_mean, 0.0);
  EXPECT_TRUE(std::isfinite(line.ip_mean) && std::isfinite(line.ip_chi2));
}

TEST(EqualCurvatures, WithinTheirNoiseAreAlsoUndetermined) {
  auto points = points_of(CurveClass::Ellipse, {2.0, 1.999, 0.0}, {0.1, 0.9, 1.7, 2.5});
  for (MeasuredGeometry& point : points) {
    point.covariance.diagonal() << 1e-8, 1e-4, 1e-2;  // kappa to 2 %; its range is 0.2 %
  }
  EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::PointsTooAlike);
}

TEST(Circle, HasNoSlopeButConstantCurvature) {
  std::vector<MeasuredGeometry> points(5);
  for (MeasuredGeometry& point : points) {
    point.kappa = -3.0;
  }
  EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::PointsTooAlike);
  const ConstantCurvature fit = fit_constant_curvature(points);
  EXPECT_EQ(fit.kappa, 3.0);
  EXPECT_LT(fit.circle_chi2, 1.0);
}

TEST(NearCircle, AxesWithin1e7OfEachOtherAreToldApart) {
  const auto points =
      points_of(CurveClass::Ellipse, {1.0000001, 1.0, 0.0}, {0.1, 0.6, 1.1, 1.5, 2.3, 4.0});
  const ConicLine line = fit_conic_line(points);
  ASSERT_EQ(line.status, InvariantStatus::Ok);
  const ConicParameters ellipse = ellipse_parameters(line.ic1, line.ic2, line.covariance);
  ASSERT_EQ(ellipse.status, InvariantStatus::Ok);
  // kappa varies by 3e-7, so a - b keeps about eight of a double's sixteen digits.
  EXPECT_NEAR(ellipse.a - ellipse.b, 1e-7, 5e-9);
  EXPECT_GT(ellipse.covariance(0, 0), 0.0);
}

TEST(FlatEllipse, OfOneToAHundredKeepsItsDigits) {
  const auto points = points_of(CurveClass::Ellipse, {100.0, 1.0, 0.0}, {0.05, 0.3, 0.8, 1.4, 2.9});
  const ConicLine line = fit_conic_line(points);
  const ConicParameters ellipse = ellipse_parameters(line.ic1, line.ic2, line.covariance);
  ASSERT_EQ(ellipse.status, InvariantStatus::Ok);
  EXPECT_NEAR(ellipse.a / 100.0, 1.0, 1e-12);
  EXPECT_NEAR(ellipse.b, 1.0, 1e-12);
}

TEST(EllipseParabolaHyperbola, MeetAtIc1ZeroWithinItsUncertainty) {
  // From an ellipse through the parabola to a hyperbola: conics of focal parameter 1 whose far
  // vertex goes to infinity. Ic1 = -+1/(ab)^(2/3) passes through zero; its sign determines the
  // class.
  for (const double a : {1e2, 1e4, 1e6}) {
    const double b = std::sqrt(a);
    const double t = 1.0 / b;
    const auto ellipse =
        points_of(CurveClass::Ellipse, {a, b, 0.0}, {-2.0 * t, -t, 0.5 * t, 1.5 * t});
    const auto hyperbola =
        points_of(CurveClass::Hyperbola, {a, b, 0.0}, {-2.0 * t, -t, 0.5 * t, 1.5 * t});
    const ConicLine ellipse_line = fit_conic_line(ellipse);
    const ConicLine hyperbola_line = fit_conic_line(hyperbola);
    ASSERT_EQ(ellipse_line.status, InvariantStatus::Ok);
    ASSERT_EQ(hyperbola_line.status, InvariantStatus::Ok);
    const double expected = std::pow(a * b, -2.0 / 3.0);
    EXPECT_NEAR(ellipse_line.ic1, expected, 5.0 * std::sqrt(ellipse_line.covariance(0, 0)));
    EXPECT_NEAR(hyperbola_line.ic1, -expected, 5.0 * std::sqrt(hyperbola_line.covariance(0, 0)));
    EXPECT_NEAR(ellipse_line.ip_mean, 1.0, 10.0 / a);  // the parabola with 2a = 1
  }
}

TEST(Vertices, HaveAnIpOfSecondOrderError) {
  // Vertices only: kappa_s = 0 at each, so the first-order variance of Ip from kappa_s vanishes.
  auto points = points_of(CurveClass::Ellipse, {2.0, 1.0, 0.0}, {0.0, 0.5 * kPi, kPi, 1.5 * kPi});
  for (MeasuredGeometry& point : points) {
    point.covariance.diagonal() << 1e-8, 1e-8, 1e-2;
  }
  const ConicLine line = fit_conic_line(points);
  ASSERT_EQ(line.status, InvariantStatus::Ok);
  EXPECT_TRUE(std::isfinite(line.chi2));
  EXPECT_NEAR(line.ic1, std::pow(2.0, -2.0 / 3.0), 4.0 * std::sqrt(line.covariance(0, 0)));
  // First order alone would give an error of about 1e-4.
  EXPECT_GT(std::sqrt(line.covariance(1, 1)), 1e-3);
}

TEST(Inflection, IsNoConicAndSaysSo) {
  std::vector<MeasuredGeometry> points(3);
  points[0].kappa = 1.0;
  points[1].kappa = 0.0;
  points[2].kappa = 2.0;
  EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::ZeroCurvature);
  EXPECT_EQ(conic_invariants(points[0], points[1]).status, InvariantStatus::ZeroCurvature);
  points[1].kappa = -1.0;
  EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::SignChange);
  EXPECT_EQ(conic_invariants(points[0], points[1]).status, InvariantStatus::SignChange);
  points[1].patch = 1;  // another patch may run in the other direction
  EXPECT_NE(fit_conic_line(points).status, InvariantStatus::SignChange);
}

TEST(Inflection, OfACubicalParabolaIsAGoodPoint) {
  const Eigen::Vector3d truth(1.3, -0.4, 0.0);
  const auto points = points_of(CurveClass::CubicalParabola, truth, {0.0, 0.5, -0.3});
  ASSERT_EQ(points[0].kappa, 0.0);
  const SemiSignatureFit fit = fit_cubical_parabola(points);
  ASSERT_EQ(fit.status, InvariantStatus::Ok);
  EXPECT_NEAR(fit.parameters[0], truth[0], 1e-9);
  EXPECT_NEAR(fit.parameters[1], truth[1], 1e-9);
}

TEST(Inflection, OfASplineIsAGoodPoint) {
  const Eigen::Vector3d truth(1.0, 0.3, 0.75);  // 3 a t^2 = c at t = 0.5
  const auto points = points_of(CurveClass::CubicSpline, truth, {0.5, -0.4, 1.1, 0.8});
  ASSERT_NEAR(points[0].kappa, 0.0, 1e-15);
  const SemiSignatureFit fit = fit_cubic_spline(points);
  ASSERT_EQ(fit.status, InvariantStatus::Ok);
  EXPECT_LT((fit.parameters - truth).norm(), 1e-8);
}

TEST(NearACusp, TheSemiCubicalIsRecoveredAcrossSixDecadesOfCurvature) {
  const Eigen::Vector3d truth(1.2, 0.5, 0.0);
  const auto points = points_of(CurveClass::SemiCubicalParabola, truth, {1e-6, -1e-5, 0.7, -0.4});
  ASSERT_GT(points[0].kappa / points[2].kappa, 1e5);
  const SemiSignatureFit fit = fit_semi_cubical_parabola(points);
  ASSERT_EQ(fit.status, InvariantStatus::Ok) << describe(fit.status);
  EXPECT_NEAR(fit.parameters[0], truth[0], 1e-8);
  EXPECT_NEAR(fit.parameters[1], truth[1], 1e-8);
}

TEST(VerticalCanonicalTangent, OfASplineIsNoSingularity) {
  const Eigen::Vector3d truth(1.1, -0.6, 0.9);
  const auto points = points_of(CurveClass::CubicSpline, truth, {0.0, 0.6, -0.5, 1.0});
  ASSERT_NEAR(std::abs(points[0].tangent_angle), 0.5 * kPi, 1e-15);
  const SemiSignatureFit fit = fit_cubic_spline(points);
  ASSERT_EQ(fit.status, InvariantStatus::Ok);
  EXPECT_LT((fit.parameters - truth).norm(), 1e-8);
}

/// Two points of a curve of the class whose tangents differ by `rotation`. Searches for t of the
/// second.
std::vector<MeasuredGeometry> pair_with_rotation(CurveClass curve_class, const Eigen::Vector3d& p,
                                                 double t, double low, double high,
                                                 double rotation) {
  const double target = test::exact_estimate({curve_class, p, {}}, t).tangent_angle + rotation;
  const auto misfit = [&](double u) {
    return std::sin(test::exact_estimate({curve_class, p, {}}, u).tangent_angle - target);
  };
  const double at_low = misfit(low);
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (misfit(middle) * at_low > 0.0 ? low : high) = middle;
  }
  return points_of(curve_class, p, {t, low});
}

TEST(RotationOfAQuarterTurn, IsNoSingularityOfTheCubicalPair) {
  const Eigen::Vector3d truth(1.5, -1.0, 0.0);  // slopes from -1 upwards
  for (const double rotation : {0.5 * kPi, -0.5 * kPi}) {
    const auto points =
        pair_with_rotation(CurveClass::CubicalParabola, truth, 0.1, 0.2, 3.0, rotation);
    const double delta = points[1].tangent_angle - points[0].tangent_angle;
    ASSERT_NEAR(std::cos(delta), 0.0, 1e-12);
    const PairSolutions pair = cubical_parabola_pair(points[0], points[1]);
    ASSERT_EQ(pair.status, InvariantStatus::Ok);
    EXPECT_NEAR(pair.solutions[0].parameters[0], truth[0], 1e-9);
    EXPECT_NEAR(pair.solutions[0].parameters[1], truth[1], 1e-9);
  }
}

TEST(RotationOfAQuarterTurn, IsNoSingularityOfTheSemiCubicalPair) {
  const Eigen::Vector3d truth(1.2, 0.4, 0.0);
  const auto points =
      pair_with_rotation(CurveClass::SemiCubicalParabola, truth, 0.8, -0.1, -3.0, 0.5 * kPi);
  ASSERT_NEAR(std::cos(points[1].tangent_angle - points[0].tangent_angle), 0.0, 1e-12);
  const PairSolutions pair = semi_cubical_parabola_pair(points[0], points[1]);
  ASSERT_EQ(pair.status, InvariantStatus::Ok);
  EXPECT_NEAR(pair.solutions[0].parameters[0], truth[0], 1e-9);
  EXPECT_NEAR(pair.solutions[0].parameters[1], truth[1], 1e-9);
}

TEST(ParallelTangents, OfSymmetricPointsLeaveTheCubicalPairUndetermined) {
  // t and -t of a cubical parabola have the same tangent, kappa^2 and kappa_s: the same point
  // twice.
  const auto points = points_of(CurveClass::CubicalParabola, {1.5, -1.0, 0.0}, {0.4, -0.4});
  EXPECT_EQ(cubical_parabola_pair(points[0], points[1]).status, InvariantStatus::PointsTooAlike);
}

TEST(RepeatedPoints, AreUndeterminedNotWrong) {
  for (const CurveClass curve_class : test::invariant_classes()) {
    const auto points = points_of(curve_class, {1.5, 0.8, -0.7}, {0.6, 0.6, 0.6, 0.6, 0.6});
    EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::PointsTooAlike);
    EXPECT_EQ(cubical_parabola_pair(points[0], points[1]).status, InvariantStatus::PointsTooAlike);
    EXPECT_EQ(semi_cubical_parabola_pair(points[0], points[1]).status,
              InvariantStatus::PointsTooAlike);
    for (const SemiSignatureFit& fit :
         {fit_cubical_parabola(points), fit_semi_cubical_parabola(points),
          fit_cubic_spline(points)}) {
      EXPECT_TRUE(finite(fit) || fit.status != InvariantStatus::Ok);
      if (fit.status ==
          InvariantStatus::Ok) {  // one of many curves through a point: its width is not known
        EXPECT_GT(fit.covariance.diagonal().maxCoeff(), 1.0);
      }
    }
  }
}

TEST(SplineOfVanishingC, IsASemiCubicalParabolaAndItsWidthOfCSaysSo) {
  const Eigen::Vector3d truth(1.5, 0.4, 1e-7);
  auto points = points_of(CurveClass::CubicSpline, truth, {0.7, -0.5, 1.0, -0.9, 0.3});
  for (MeasuredGeometry& point : points) {
    point.covariance.diagonal() << 1e-10, 1e-8, 1e-6;
  }
  const SemiSignatureFit semi = fit_semi_cubical_parabola(points);
  ASSERT_EQ(semi.status, InvariantStatus::Ok);
  EXPECT_LT(semi.chi2, 1.0);
  EXPECT_NEAR(semi.parameters[0], 1.5, 1e-5);
  EXPECT_NEAR(semi.parameters[1], 0.4, 1e-5);
  const SemiSignatureFit spline = fit_semi_signature(CurveClass::CubicSpline, points, truth, 0.0);
  ASSERT_TRUE(finite(spline));
  EXPECT_GT(std::sqrt(spline.covariance(2, 2)), 1e-5);  // a hundred times c
}

TEST(SplineOfVanishingA, IsAParabolaAndTheFitStaysFinite) {
  // a -> 0: (t^2, b t^2 + c t) is a parabola, and the spline's own frame loses its meaning.
  for (const double a : {1e-3, 1e-6, 1e-9}) {
    const auto points =
        points_of(CurveClass::CubicSpline, {a, 0.4, 1.2}, {0.7, -0.5, 1.0, -0.9, 0.3});
    EXPECT_TRUE(finite(fit_semi_signature(CurveClass::CubicSpline, points, {a, 0.4, 1.2}, 0.0)));
    const SemiSignatureFit fit = fit_cubic_spline(points);
    EXPECT_TRUE(fit.status != InvariantStatus::Ok || finite(fit));
    auto tolerant = points;
    for (MeasuredGeometry& point : tolerant) {
      point.covariance.diagonal() << 1e-6, 1e-4, 1e-2;
    }
    const ConicLine line = fit_conic_line(tolerant);
    ASSERT_EQ(line.status, InvariantStatus::Ok);
    EXPECT_LT(line.ip_chi2, 1.0);  // a parabola within these errors
  }
}

TEST(StraightLine, HasNoInvariantAndEveryFitSaysWhy) {
  const std::vector<MeasuredGeometry> points(4);
  EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::ZeroCurvature);
  EXPECT_EQ(cubical_parabola_pair(points[0], points[1]).status, InvariantStatus::ZeroCurvature);
  EXPECT_EQ(semi_cubical_parabola_pair(points[0], points[1]).status,
            InvariantStatus::ZeroCurvature);
  EXPECT_EQ(fit_cubical_parabola(points).status, InvariantStatus::ZeroCurvature);
  EXPECT_EQ(fit_semi_cubical_parabola(points).status, InvariantStatus::ZeroCurvature);
  EXPECT_EQ(fit_cubic_spline(points).status, InvariantStatus::NoRealRoot);
  EXPECT_TRUE(spline_least_squares(points).empty());
}

TEST(NotANumber, AndInfinitiesAreRefusedEverywhere) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    for (int field = 0; field < 4; ++field) {
      auto points = points_of(CurveClass::Ellipse, {2.0, 1.0, 0.0}, {0.3, 0.9, 1.4, 2.0});
      (field == 0   ? points[1].tangent_angle
       : field == 1 ? points[1].kappa
       : field == 2 ? points[1].kappa_s
                    : points[1].covariance(1, 1)) = bad;
      EXPECT_EQ(conic_invariants(points[0], points[1]).status, InvariantStatus::NotFinite);
      EXPECT_EQ(fit_conic_line(points).status, InvariantStatus::NotFinite);
      EXPECT_EQ(fit_constant_curvature(points).status, InvariantStatus::NotFinite);
      EXPECT_EQ(cubical_parabola_pair(points[0], points[1]).status, InvariantStatus::NotFinite);
      EXPECT_EQ(semi_cubical_parabola_pair(points[0], points[1]).status,
                InvariantStatus::NotFinite);
      EXPECT_EQ(fit_cubical_parabola(points).status, InvariantStatus::NotFinite);
      EXPECT_EQ(fit_cubic_spline(points).status, InvariantStatus::NotFinite);
    }
  }
}

TEST(AnyInput, OfAnySizeGivesAStatusOrFiniteNumbers) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> exponent(-150.0, 150.0);
  std::uniform_real_distribution<double> angle(-10.0, 10.0);
  for (int i = 0; i < test::stress_count(3000); ++i) {
    std::vector<MeasuredGeometry> points(4);
    for (MeasuredGeometry& point : points) {
      point.tangent_angle = angle(rng);
      point.kappa = std::copysign(std::pow(10.0, exponent(rng)), angle(rng));
      point.kappa_s = std::copysign(std::pow(10.0, exponent(rng)), angle(rng));
      point.patch = static_cast<int>(rng() % 4);
    }
    const ConicInvariants pair = conic_invariants(points[0], points[1]);
    EXPECT_TRUE(std::isfinite(pair.ic1) && std::isfinite(pair.ic2) && pair.covariance.allFinite());
    const ConicLine line = fit_conic_line(points);
    EXPECT_TRUE(
        line.status != InvariantStatus::Ok ||
        (std::isfinite(line.ic1) && std::isfinite(line.ic2) && line.covariance.allFinite()));
    for (const PairSolutions& solutions : {cubical_parabola_pair(points[0], points[1]),
                                           semi_cubical_parabola_pair(points[0], points[1])}) {
      for (int k = 0; k < solutions.count; ++k) {
        const PairSolution& solution = solutions.solutions[static_cast<std::size_t>(k)];
        EXPECT_TRUE(solution.parameters.allFinite() && std::isfinite(solution.angle));
        EXPECT_FALSE(solution.covariance.hasNaN());
      }
    }
    for (const SemiSignatureFit& fit :
         {fit_cubical_parabola(points), fit_semi_cubical_parabola(points),
          fit_cubic_spline(points)}) {
      EXPECT_TRUE(fit.status != InvariantStatus::Ok || finite(fit));
    }
  }
}

}  // namespace
}  // namespace palpate
