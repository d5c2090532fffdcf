// Foot points of random curves, compared with brute force.
#include "core/curves/foot_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/curves/curve.h"
#include "tests/property/curves/random_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

class FootPointProperties : public testing::TestWithParam<CurveClass> {};

/// Least distance over the whole curve: a grid uniform in asinh t, so that it reaches any foot
/// point, then golden-section search around each of its local minima.
double brute_force_distance(const Curve& curve, const Vec2& point, double reach) {
  const auto distance = [&](double t) { return (position(curve, t) - point).norm(); };
  constexpr int kCells = 600;
  const double end = std::asinh(reach);
  const auto grid = [&](int i) { return std::sinh(end * (2.0 * i / kCells - 1.0)); };
  double best = std::min(distance(grid(0)), distance(grid(kCells)));
  for (int i = 1; i < kCells; ++i) {
    double low = grid(i - 1);
    double high = grid(i + 1);
    if (distance(grid(i)) > distance(low) || distance(grid(i)) > distance(high)) {
      continue;
    }
    constexpr double kGolden = 0.6180339887498949;
    for (int k = 0; k < 60; ++k) {
      const double left = high - kGolden * (high - low);
      const double right = low + kGolden * (high - low);
      (distance(left) < distance(right) ? high : low) =
          distance(left) < distance(right) ? right : left;
    }
    best = std::min(best, distance(0.5 * (low + high)));
  }
  return best;
}

/// A parameter beyond which the distance of the curve from the point exceeds twice the point's
/// distance from the origin.
double far_parameter(const Curve& curve, const Vec2& point) {
  if (domain(curve).period > 0.0) {
    return kPi;
  }
  double t = 1.0;
  while (position(curve, t).norm() < 2.0 * point.norm() + 3.0 ||
         position(curve, -t).norm() < 2.0 * point.norm() + 3.0) {
    t *= 1.5;
  }
  return t;
}

TEST_P(FootPointProperties, IsTheNearestOfAllPoints) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double reach = std::pow(10.0, uniform(rng, -3.0, 2.0));
    const Vec2 point(uniform(rng, -reach, reach), uniform(rng, -reach, reach));
    const FootPoint foot = foot_point(random.curve, point);
    const double size = point.norm() + foot.position.norm();
    // Positions and distances are rounded to a few epsilon of the coordinates.
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * size;
    EXPECT_LE((foot.position - position(random.curve, foot.t)).norm(), rounding);
    EXPECT_NEAR(std::abs(foot.distance), (point - foot.position).norm(), rounding);
    const double brute =
        brute_force_distance(random.curve, point, far_parameter(random.curve, point));
    // Golden section determines t to the square root of epsilon, the distance to epsilon.
    EXPECT_LE(std::abs(foot.distance), brute + rounding)
        << random.values.transpose() << " point " << point.transpose() << " t " << foot.t;
    EXPECT_GE(foot.t, domain(random.curve).lower);
    EXPECT_LE(foot.t, domain(random.curve).upper);
    // Perpendicular except for the rounding of the point itself; a cusp has no direction.
    const CurveDerivatives d = derivatives(random.curve, foot.t);
    const double error_of_t = 4.0 * std::numeric_limits<double>::epsilon() * std::abs(foot.t);
    const double second = d.first.squaredNorm() + size * d.second.norm();
    EXPECT_LE(std::abs((point - foot.position).dot(d.first)),
              2.0 * rounding * d.first.norm() + error_of_t * second);
  }
}

TEST_P(FootPointProperties, OffsetPointsComeBackWithSideAndDistance) {
  std::mt19937_64 rng = test::test_rng();
  int checked = 0;
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t = random.random_t(rng);
    if (GetParam() == CurveClass::SemiCubicalParabola && std::abs(t) < 0.3) {
      // Next to the cusp such a point is beyond the other arm; the cusp has tests of its own.
      continue;
    }
    const CurveDerivatives d = derivatives(random.curve, t);
    // The length over which the curvature stays below the inverse of that length. The radius of
    // curvature is not such a length at a flat place next to a sharp bend.
    const LocalGeometry g = geometry(random.curve, t);
    const double length = 1.0 / std::sqrt(g.kappa * g.kappa + std::abs(g.kappa_s) + 1.0);
    const double offset = uniform(rng, -0.4, 0.4) * length;
    const Vec2 point = d.position + offset * left_of(d.first).normalized();
    // The local search, from a tenth of that length away; for every offset, whether or not other
    // arms are near.
    const double start = t + uniform(rng, -0.1, 0.1) * length / d.first.norm();
    const FootPoint near = foot_point_near(random.curve, point, start);
    const double rounding = 1e-14 * (1.0 + d.position.norm());
    EXPECT_NEAR(near.distance, offset, rounding);
    EXPECT_LE((near.position - d.position).norm(), 4.0 * rounding) << t << " " << near.t;
    // The global search finds this foot point, or another arm that is nearer.
    const FootPoint foot = foot_point(random.curve, point);
    EXPECT_LE(std::abs(foot.distance), std::abs(offset) + rounding);
    if ((foot.position - d.position).norm() < 1e-6) {
      EXPECT_NEAR(foot.distance, offset, rounding);
      ++checked;
    }
  }
  if (test::counts_tell()) {
    EXPECT_GT(checked, 300);
  }
}

TEST_P(FootPointProperties, NearAgreesWithGlobalAlongAPath) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(50); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    // A smooth path 10 um from the curve, like that of a touching tip.
    double t = 0.1;
    FootPoint tracked = foot_point(random.curve, position(random.curve, t));
    for (int k = 0; k < 100; ++k) {
      t += 0.01;
      const Vec2 point =
          position(random.curve, t) + 1e-5 * Vec2(uniform(rng, -1.0, 1.0), uniform(rng, -1.0, 1.0));
      tracked = foot_point_near(random.curve, point, tracked.t);
      EXPECT_LE((tracked.position - position(random.curve, t)).norm(), 3e-5);
      const double global = foot_point(random.curve, point).distance;
      EXPECT_LE(std::abs(global), std::abs(tracked.distance) + 1e-14);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, FootPointProperties, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
