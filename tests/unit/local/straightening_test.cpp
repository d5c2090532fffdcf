// Coordinates in which a circle is a straight line.
#include "core/local/stream/straightening.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "core/local/stream/sliding_window.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kRadius_m = 0.02;
const Vec2 kCentre(3.0, -2.0);

Vec2 on_circle(double angle, double radius_m = kRadius_m) {
  return kCentre + radius_m * Vec2(std::cos(angle), std::sin(angle));
}

std::vector<PathNode> arc(double half_turn, int turning) {
  std::vector<PathNode> nodes;
  constexpr int kNodes = 41;
  for (int i = 0; i < kNodes; ++i) {
    nodes.push_back({on_circle(turning * half_turn * (2.0 * i / (kNodes - 1) - 1.0)), 1.0});
  }
  return nodes;
}

TEST(Straightening, MakesACircleAStraightLineAndKeepsItsMiddle) {
  for (const int turning : {1, -1}) {
    const Straightening straight(arc(2.0, turning));
    EXPECT_NEAR(straight.kappa() * kRadius_m, turning, 1e-12);
    for (const double phi : {-2.0, -1.0, -0.1, 0.0, 0.5, 1.9}) {
      const Straightening::Point point = straight.to_line(on_circle(turning * phi));
      EXPECT_NEAR(point.w_m.x(), 2.0 * kRadius_m * std::tan(0.5 * phi), 1e-13);
      EXPECT_NEAR(point.w_m.y(), 0.0, 1e-13);
      EXPECT_NEAR(point.shrink, std::pow(std::cos(0.5 * phi), 2), 1e-12);
      EXPECT_NEAR(straight.arc_m(0.0, point.w_m.x()), kRadius_m * phi, 1e-13);
    }
  }
}

TEST(Straightening, PointsOnALineAreNotMoved) {
  std::vector<PathNode> nodes;
  for (int i = 0; i <= 20; ++i) {
    nodes.push_back({Vec2(1.0 + 0.3 * i, 2.0 - 0.1 * i), 1.0});
  }
  const Straightening straight(nodes);
  EXPECT_NEAR(straight.kappa(), 0.0, 1e-15);
  const double step = (nodes[1].position_m - nodes[0].position_m).norm();
  for (int i = 0; i <= 20; ++i) {
    const Straightening::Point point =
        straight.to_line(nodes[static_cast<std::size_t>(i)].position_m);
    EXPECT_NEAR(point.w_m.x(), step * (i - 10), 1e-14);
    EXPECT_NEAR(point.w_m.y(), 0.0, 1e-14);
    EXPECT_NEAR(point.shrink, 1.0, 1e-14);
  }
}

/// The exact geometry of a cubic graph in the straightened plane, in metres.
LocalEstimate on_cubic(double u) {
  const std::array c = {1e-4, 0.1, 4.0, 900.0};  // of 1, x, x^2, x^3
  const double first = c[1] + u * (2.0 * c[2] + 3.0 * u * c[3]);
  const double second = 2.0 * c[2] + 6.0 * u * c[3];
  const double third = 6.0 * c[3];
  const double g = 1.0 + first * first;
  LocalEstimate e;
  e.position = {u, c[0] + u * (c[1] + u * (c[2] + u * c[3]))};
  e.tangent_angle = std::atan(first);
  e.kappa = second * std::pow(g, -1.5);
  e.kappa_s = (third * g - 3.0 * first * second * second) / (g * g * g);
  return e;
}

TEST(Straightening, GeometryComesBackAsThatOfThePathInTheWorld) {
  const Straightening straight(arc(1.7, -1));
  constexpr double kStep_m = 1e-5;
  for (const double u : {-0.008, 0.0, 0.003, 0.011}) {
    const auto before = straight.to_world(on_cubic(u - kStep_m));
    const auto at = straight.to_world(on_cubic(u));
    const auto after = straight.to_world(on_cubic(u + kStep_m));
    // The inverse of to_line.
    EXPECT_LT((straight.to_line(at.position).w_m - on_cubic(u).position).norm(), 1e-15);
    const Vec2 chord = after.position - before.position;
    const double ds = chord.norm();
    EXPECT_NEAR(wrap_angle(std::atan2(chord.y(), chord.x()) - at.tangent_angle), 0.0, 1e-6);
    EXPECT_NEAR(wrap_angle(after.tangent_angle - before.tangent_angle) / ds, at.kappa,
                1e-5 * std::abs(at.kappa));
    EXPECT_NEAR((after.kappa - before.kappa) / ds, at.kappa_s, 1e-4 * std::abs(at.kappa_s));
  }
}

/// An error of the estimate against the truth at its foot, of (offset, angle, kappa, kappa_s): in
/// the world what the covariance says of it in the straightened plane.
TEST(Straightening, CovarianceIsThatOfErrorsAgainstTheTruthAtTheFoot) {
  const Straightening straight(arc(1.7, 1));
  const LocalEstimate truth = on_cubic(0.004);
  const LocalEstimate there = straight.to_world(truth);
  const Vec2 normal = left_of({std::cos(truth.tangent_angle), std::sin(truth.tangent_angle)});
  const Vec2 world_normal = left_of({std::cos(there.tangent_angle), std::sin(there.tangent_angle)});
  const Eigen::Vector4d sizes(1e-9, 1e-7, 1e-5, 1e-3);
  for (Eigen::Index k = 0; k < 4; ++k) {
    LocalEstimate off = truth;
    Eigen::Vector4d error = Eigen::Vector4d::Zero();
    error[k] = sizes[k];
    off.position += error[0] * normal;
    off.tangent_angle += error[1];
    off.kappa += error[2];
    off.kappa_s += error[3];
    off.covariance = error * error.transpose();
    const LocalEstimate seen = straight.to_world(off);
    const Eigen::Vector4d found(world_normal.dot(seen.position - there.position),
                                wrap_angle(seen.tangent_angle - there.tangent_angle),
                                seen.kappa - there.kappa, seen.kappa_s - there.kappa_s);
    const Eigen::Matrix4d expected = found * found.transpose();
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index j = 0; j < 4; ++j) {
        EXPECT_NEAR(seen.covariance(i, j), expected(i, j),
                    1e-3 * std::abs(expected(i, j)) + 1e-6 * sizes[i] * sizes[j])
            << k << ": " << i << ", " << j;
      }
    }
  }
}

TEST(Straightening, AWindowOnACircleIsAsLongAsTheStrokeUpToTwoThirdsOfATurn) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, 2e-5);
  SlidingWindow window({.sigma_m = 2e-5});
  double longest = 0.0;
  constexpr double kStep = 0.01;
  for (int i = 0; i < 600; ++i) {
    const auto estimate = window.add(on_circle(kStep * i) + Vec2(normal(rng), normal(rng)));
    if (estimate && estimate->result) {
      longest = std::max(longest, estimate->result.estimate.window_arc_m);
    }
  }
  EXPECT_GT(longest, 0.8 * 2.0 / 3.0 * 2.0 * kPi * kRadius_m);
}

}  // namespace
}  // namespace palpate
