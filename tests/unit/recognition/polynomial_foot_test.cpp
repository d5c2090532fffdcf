// Foot points as good as the noise asks for.
#include "core/recognition/fit/orthogonal/polynomial_foot.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// The largest curvature next to t.
double sharpest_bend(const PolynomialCoefficients& c, double t) {
  double sharpest = 0.0;
  for (int i = -10; i <= 10; ++i) {
    const Vec2 first = first_derivative(c, t + 2e-3 * i);
    const double speed = first.norm();
    const double bend = cross(first, second_derivative(c, t + 2e-3 * i));
    sharpest = std::max(sharpest, std::abs(bend) / (speed * speed * speed));
  }
  return sharpest;
}

TEST(PolynomialFoot, DistancesErrByLittleBesideTheNoise) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  std::normal_distribution<double> normal;
  for (const double sigma : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (int i = 0; i < 1000; ++i) {
      PolynomialCoefficients c;
      for (Eigen::Index k = 0; k < 4; ++k) {
        c.col(k) = Vec2(within(rng), within(rng));
      }
      const double t = within(rng);
      const Vec2 first = first_derivative(c, t);
      if (sharpest_bend(c, t) > 30.0) {
        continue;  // its third-order terms are beyond what foot points are followed for
      }
      const Vec2 point = position_at(c, t) + sigma * normal(rng) * left_of(first) / first.norm();
      const double start = t + 0.01 * within(rng);
      const PlacedPoint exact = follow_foot_point(c, point, start, 0.0);
      const PlacedPoint placed = follow_foot_point(c, point, start, last_foot_step(sigma));
      // A thousandth, and the rounding of coordinates of some units.
      EXPECT_NEAR(placed.signed_distance, exact.signed_distance, 1e-3 * sigma + 4e-15);
    }
  }
}

TEST(PolynomialFoot, NearestPlaceIsNoFartherThanAnyOther) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    PolynomialCoefficients c;
    for (Eigen::Index k = 0; k < 4; ++k) {
      // Parabolas and lines among them.
      c.col(k) = k > 0 && k % 4 == i % 4 ? Vec2::Zero() : Vec2(within(rng), within(rng));
    }
    const Vec2 point(within(rng), within(rng));
    const double nearest = (position_at(c, nearest_parameter(c, point)) - point).norm();
    for (double t = -5.0; t <= 5.0; t += 1e-2) {
      ASSERT_LE(nearest, (position_at(c, t) - point).norm() + 1e-12);
    }
  }
}

/// On which side of a curve a point lies does not depend on which of its arms is followed there.
TEST(PolynomialFoot, AboutACuspLiesOnTheSideThatIsOutsideOfBothArms) {
  std::mt19937_64 rng = test::test_rng();
  int behind = 0;
  for (int i = 0; i < 1000; ++i) {
    const double a = test::uniform(rng, 0.2, 2.0);
    const double b = test::uniform(rng, -1.0, 1.0);
    const double turn = test::uniform(rng, -kPi, kPi);
    const Eigen::Rotation2Dd rotation(turn);
    // (t^2, a t^3 + b t^2), elsewhere and turned; its arms leave the cusp along (1, b). With rising
    // t both have the outside on their left, with falling t on their right.
    PolynomialCoefficients c = PolynomialCoefficients::Zero();
    c.col(0) = Vec2(test::uniform(rng, -0.5, 0.5), test::uniform(rng, -0.5, 0.5));
    c.col(2) = rotation * Vec2(1.0, b);
    c.col(3) = rotation * Vec2(0.0, a);
    PolynomialCoefficients reversed = c;
    reversed.col(3) *= -1.0;
    // What lies behind the cusp has it for its nearest place, unless an arm bends towards it.
    constexpr double kBehind = 0.5 * kPi - 0.05;  // [rad]
    const double across = test::uniform(rng, -kBehind, kBehind);
    const double distance = test::log_uniform(rng, 1e-3, 0.5);
    const Vec2 away = distance * (Eigen::Rotation2Dd(across) * -Vec2(c.col(2)).normalized());
    const Vec2 point = c.col(0) + away;
    if (std::abs(nearest_parameter(c, point)) > 1e-6) {
      continue;
    }
    ++behind;
    // The two arms, at a point beside each.
    for (const double t : {-0.5, 0.5}) {
      const Vec2 left = left_of(first_derivative(c, t)).normalized();
      const Vec2 beside = position_at(c, t) + 1e-3 * left;
      ASSERT_GT(follow_foot_point(c, beside, t).signed_distance, 0.0);
      ASSERT_LT(follow_foot_point(reversed, beside, -t).signed_distance, 0.0);
    }
    const double start = 0.02 * test::uniform(rng, -1.0, 1.0);
    for (const double last_step : {kExactFootStep, last_foot_step(1e-3)}) {
      const PlacedPoint placed = follow_foot_point(c, point, start, last_step, PointOf::Tip);
      const PlacedPoint other = follow_foot_point(reversed, point, -start, last_step, PointOf::Tip);
      EXPECT_GT(placed.signed_distance, 0.0) << i << ", start " << start << ", angle " << across;
      EXPECT_LT(other.signed_distance, 0.0) << i << ", start " << start << ", angle " << across;
      EXPECT_NEAR(std::abs(placed.signed_distance), distance, 0.1 * distance) << i;
      EXPECT_NEAR(std::abs(other.signed_distance), distance, 0.1 * distance) << i;
    }
  }
  EXPECT_GT(behind, 900);
}

TEST(PolynomialFoot, ReachesTheFootPointFromAfar) {
  // The parabola y = x^2 and the point (0, 1 / 4): its foot is the vertex, wherever one starts.
  PolynomialCoefficients c = PolynomialCoefficients::Zero();
  c.col(1) = Vec2(1.0, 0.0);
  c.col(2) = Vec2(0.0, 1.0);
  for (const double start : {-0.9, -0.3, 0.0, 0.2, 0.8}) {
    const PlacedPoint placed = follow_foot_point(c, Vec2(0.0, 0.25), start);
    EXPECT_NEAR(placed.t, 0.0, 1e-9);
    EXPECT_NEAR(placed.signed_distance, 0.25, 1e-15);
    EXPECT_NEAR(placed.normal.y(), 1.0, 1e-15);
  }
}

}  // namespace
}  // namespace palpate
