// Nearest points where they are known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/curves/curve.h"
#include "core/curves/foot_point.h"

namespace palpate {
namespace {

TEST(FootPoint, CircleInsideOutsideAndCentre) {
  const Circle circle{2.0};
  EXPECT_NEAR(circle.foot_point({3.0, 0.0}).distance, -1.0, 1e-15);
  EXPECT_NEAR(circle.foot_point({0.0, 0.5}).distance, 1.5, 1e-15);
  EXPECT_NEAR(circle.foot_point({0.0, 0.0}).distance, 2.0, 1e-15);
}

TEST(FootPoint, EllipseAxes) {
  const Ellipse ellipse{2.0, 1.0};
  EXPECT_NEAR(ellipse.foot_point({3.0, 0.0}).t, 0.0, 1e-15);
  EXPECT_NEAR(ellipse.foot_point({0.0, -4.0}).t, -0.5 * kPi, 1e-15);
  // Beyond the evolute's cusp at (a^2 - b^2) / a = 1.5 the vertex is nearest, before it a pair.
  EXPECT_NEAR(ellipse.foot_point({1.6, 0.0}).t, 0.0, 1e-15);
  EXPECT_NEAR(std::abs(ellipse.foot_point({0.75, 0.0}).t), std::acos(0.5), 1e-14);
  EXPECT_NEAR(std::abs(ellipse.foot_point({0.0, 0.0}).distance), 1.0, 1e-15);
}

TEST(FootPoint, ParabolaFocusAndFarAway) {
  const Parabola parabola{0.5};
  EXPECT_NEAR(parabola.foot_point({0.5, 0.0}).t, 0.0, 1e-12);
  EXPECT_NEAR(std::abs(parabola.foot_point({-1e6, 0.0}).distance), 1e6, 1e-9);
  // On the axis beyond 2 a the feet are a pair: t^2 = x/a - 2.
  EXPECT_NEAR(std::abs(parabola.foot_point({3.0, 0.0}).t), 2.0, 1e-12);
}

TEST(FootPoint, HyperbolaAxis) {
  const Hyperbola hyperbola{3.0, 4.0};
  EXPECT_EQ(hyperbola.foot_point({0.0, 0.0}).t, 0.0);
  EXPECT_NEAR(hyperbola.foot_point({0.0, 0.0}).distance, 3.0, 1e-15);
  // Up to the evolute's cusp at (a^2 + b^2) / a the vertex, beyond it cosh t = a x / (a^2 + b^2).
  EXPECT_NEAR(hyperbola.foot_point({8.0, 0.0}).t, 0.0, 1e-15);
  EXPECT_NEAR(std::abs(hyperbola.foot_point({12.5, 0.0}).t), std::acosh(1.5), 1e-15);
}

TEST(FootPoint, CuspTakesTheTrueDistance) {
  const SemiCubicalParabola cusp{1.0, 0.0};
  const FootPoint foot = cusp.foot_point({-4.0, 0.3});
  EXPECT_EQ(foot.t, 0.0);
  EXPECT_NEAR(foot.distance, std::hypot(4.0, 0.3), 1e-15);
  EXPECT_NEAR(cusp.foot_point({-4.0, -0.3}).distance, std::hypot(4.0, 0.3), 1e-15);
}

TEST(FootPoint, CuspDistanceIsContinuousAroundAndNegativeBetweenTheArms) {
  for (const double b : {0.0, 0.7, -3.0}) {
    const SemiCubicalParabola cusp{1.3, b};
    constexpr double kRadius = 0.1;
    constexpr int kSteps = 20000;
    double before = cusp.foot_point({kRadius, b * kRadius}).distance;
    EXPECT_LT(before, 0.0);  // on the line of the cusp's tangent
    for (int i = 1; i <= kSteps; ++i) {
      const double angle = std::atan(b) + 2.0 * kPi * i / kSteps;
      const Vec2 point = std::hypot(1.0, b) * kRadius * Vec2(std::cos(angle), std::sin(angle));
      const double distance = cusp.foot_point(point).distance;
      // A distance changes no faster than its point moves.
      const double step = std::hypot(1.0, b) * kRadius * 2.0 * kPi / kSteps;
      EXPECT_LE(std::abs(distance - before), step * (1.0 + 1e-9)) << b << " " << angle;
      before = distance;
    }
  }
}

TEST(FootPoint, SideIsLeftOfIncreasingT) {
  const CubicalParabola cubic{1.0, 0.0};
  EXPECT_GT(cubic.foot_point({0.1, 0.5}).distance, 0.0);
  EXPECT_LT(cubic.foot_point({0.1, -0.5}).distance, 0.0);
}

TEST(FootPointNear, StaysOnItsArmWhereTheGlobalFootChanges) {
  // On the axis beyond the evolute's cusp the two feet of a parabola are equally near.
  const Parabola parabola{1.0};
  const Vec2 point(6.0, 1e-3);
  EXPECT_GT(parabola.foot_point(point).t, 0.0);
  const FootPoint lower = foot_point_near(parabola, point, -2.1);
  EXPECT_LT(lower.t, 0.0);
  const Vec2 away = point - lower.position;
  EXPECT_NEAR(away.dot(parabola.derivatives(lower.t).first), 0.0, 1e-13);
}

TEST(FootPointNear, RunsOnPastTheEndOfTheDomain) {
  const Curve ellipse = Ellipse{2.0, 1.0};
  double t = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double expected = 0.05 * i;  // eight turns
    t = foot_point_near(ellipse, position(ellipse, expected), t).t;
    EXPECT_NEAR(t, expected, 1e-13 * (1.0 + expected));
  }
}

TEST(FootPointNear, FallsBackToTheGlobalFoot) {
  const Curve ellipse = Ellipse{2.0, 1.0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec2 point(3.0, 1.0);
  const FootPoint global = foot_point(ellipse, point);
  // Opposite: the distance has a maximum near there. NaN: no start at all.
  for (const double start : {global.t + kPi, nan}) {
    const FootPoint foot = foot_point_near(ellipse, point, start);
    EXPECT_NEAR(std::remainder(foot.t - global.t, 2.0 * kPi), 0.0, 1e-14);
    EXPECT_NEAR(foot.distance, global.distance, 1e-15);
  }
}

}  // namespace
}  // namespace palpate
