// Nearest points where they are known in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "core/curves/curve.h"

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

TEST(FootPoint, CuspTakesTheTrueDistance) {
  const SemiCubicalParabola cusp{1.0, 0.0};
  const FootPoint foot = cusp.foot_point({-4.0, 0.3});
  EXPECT_NEAR(foot.t, 0.0, 1e-12);
  EXPECT_NEAR(foot.distance, std::hypot(4.0, 0.3), 1e-12);
}

TEST(FootPoint, SideIsLeftOfIncreasingT) {
  const CubicalParabola cubic{1.0, 0.0};
  EXPECT_GT(cubic.foot_point({0.1, 0.5}).distance, 0.0);
  EXPECT_LT(cubic.foot_point({0.1, -0.5}).distance, 0.0);
}

}  // namespace
}  // namespace palpate
