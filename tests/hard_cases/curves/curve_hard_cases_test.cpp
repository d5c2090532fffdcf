// Hard cases of the curves, each with a name and a defined outcome.
#include <gtest/gtest.h>

#include <cmath>

#include "core/curves/curve.h"

namespace palpate {
namespace {

TEST(CurveHardCases, EllipseWithinOnePartInTenMillionOfACircle) {
  const Ellipse ellipse{1.0 + 1e-7, 1.0};
  const LocalGeometry g = ellipse.geometry(0.3);
  // kappa_s = -3 ab (a^2 - b^2) s c / D^3; no factor has cancellation.
  const double expected = -3.0 * (2e-7 + 1e-14) * std::sin(0.3) * std::cos(0.3);
  EXPECT_NEAR(g.kappa_s / expected, 1.0, 1e-6);  // D = 1 + O(1e-7)
  const auto place = ellipse.localise(g);
  ASSERT_TRUE(place.has_value());
  // (a^2 + b^2 - 2 D) loses digits to 1e-7, so t is known to about 1e-9.
  EXPECT_NEAR(place->t, 0.3, 1e-8);
}

TEST(CurveHardCases, EllipseAHundredTimesLongerThanWide) {
  const Ellipse ellipse{100.0, 1.0};
  EXPECT_NEAR(ellipse.geometry(0.0).kappa, 100.0, 1e-12);
  for (const double t : {0.0, 1e-3, 0.5, 1.5, 3.1}) {
    const Vec2 normal = left_of(ellipse.derivatives(t).first).normalized();
    // 0.003 inside: less than the vertex's radius of curvature, 0.01.
    const FootPoint foot = ellipse.foot_point(ellipse.position(t) + 0.003 * normal);
    EXPECT_NEAR(std::abs(foot.distance), 0.003, 1e-12);
  }
  // The circumference for a/b = 100, by the complete elliptic integral: 400.1098329722651.
  EXPECT_NEAR(ellipse.arc_length(-kPi, kPi), 400.1098329722651, 1e-9);
}

TEST(CurveHardCases, VerticesHaveVanishingDerivativeAndKnownPlace) {
  const Ellipse ellipse{2.0, 1.0};
  for (const double t : {0.0, 0.5 * kPi}) {
    const auto place = ellipse.localise(ellipse.geometry(t));
    ASSERT_TRUE(place.has_value());
    EXPECT_NEAR(std::remainder(place->t - t, kPi), 0.0, 1e-14);
  }
}

TEST(CurveHardCases, InflectionIsLocalised) {
  const CubicalParabola cubic{0.7, -0.3};
  const auto place = cubic.localise(cubic.geometry(0.0));
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->t, 0.0);
}

TEST(CurveHardCases, NearACuspCurvatureGrowsWithoutBoundAndStaysOrdered) {
  const SemiCubicalParabola cusp{1.2, -0.8};
  double before = 0.0;
  for (double t = 1.0; t > 1e-150; t *= 0.1) {
    const LocalGeometry g = cusp.geometry(t);
    EXPECT_TRUE(std::isfinite(g.kappa));
    EXPECT_GT(g.kappa, before);
    before = g.kappa;
  }
  const LocalGeometry at = cusp.geometry(0.0);
  EXPECT_TRUE(std::isinf(at.kappa));
  EXPECT_FALSE(std::isnan(at.kappa_s));
  EXPECT_NEAR(cusp.parameter_at_arc_length(0.0, cusp.arc_length(0.0, -0.5)), -0.5, 1e-12);
}

TEST(CurveHardCases, BothSidesOfASplinesInflectionAreLocalised) {
  // The slope is extreme there: the angle alone determines t to the square root of rounding, or not
  // at all.
  const CubicSpline spline{1.1, 0.3, 0.8};
  const double inflection = std::sqrt(0.8 / 3.3);
  for (const double offset : {0.0, 1e-15, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3}) {
    for (const double sign : {1.0, -1.0}) {
      const double t = sign * (inflection + offset);
      const auto place = spline.localise(spline.geometry(t));
      ASSERT_TRUE(place.has_value()) << t;
      EXPECT_NEAR(place->t, t, 1e-14);
      EXPECT_TRUE(place->along_increasing_t);
    }
  }
  // A slope beyond the extreme one, as noise can produce it: the result is the inflection next to
  // it.
  LocalGeometry beyond = spline.geometry(inflection);
  beyond.tangent_angle -= 1e-4;
  const auto place = spline.localise(beyond);
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR(place->t, inflection, 1e-3);
}

TEST(CurveHardCases, EveryLocalisationNextToACusp) {
  const SemiCubicalParabola cusp{1.2, -0.8};
  for (const double t : {1e-3, -1e-3, 1e-6, -1e-9, 1e-12, -1e-15}) {
    const auto place = cusp.localise(cusp.geometry(t));
    ASSERT_TRUE(place.has_value());
    // By kappa, because the slope differs from b by 1.8 t only.
    EXPECT_NEAR(place->t / t, 1.0, 1e-14);
    EXPECT_TRUE(place->along_increasing_t);
  }
}

TEST(CurveHardCases, ArcsOfVerySlenderEllipsesEnd) {
  // The rounding of t next to t = pi changes the speed by more than any relative tolerance.
  for (const double ratio : {1e2, 1e6, 1e10, 1e15}) {
    const Ellipse ellipse{ratio, 1.0};
    // The integral of |sin t|. The width adds less than (3 + ln(a/b)) / (a/b)^2 on either side of t
    // = pi.
    EXPECT_NEAR(ellipse.arc_length(0.1, 6.0) / ratio, 2.0 + std::cos(0.1) + std::cos(6.0),
                2.0 * (3.0 + std::log(ratio)) / (ratio * ratio) + 2e-15);
    EXPECT_NEAR(ellipse.parameter_at_arc_length(0.1, ellipse.arc_length(0.1, 6.0)), 6.0, 1e-12);
  }
}

TEST(CurveHardCases, SplineTowardsTheSemiCubicalParabola) {
  const SemiCubicalParabola limit{1.5, 0.4};
  for (const double c : {1e-3, 1e-6, 1e-12, 1e-100}) {
    const CubicSpline spline{1.5, 0.4, c};
    for (const double t : {-1.0, -0.3, 0.3, 1.0}) {
      EXPECT_LE((spline.position(t) - limit.position(t)).norm(), 2.0 * c);
      EXPECT_NEAR(spline.geometry(t).kappa, limit.geometry(t).kappa, 100.0 * c + 1e-12);
    }
    EXPECT_TRUE(std::isfinite(spline.arc_length(-1.0, 1.0)));
  }
}

}  // namespace
}  // namespace palpate
