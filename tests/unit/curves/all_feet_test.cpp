// All feet of a point on a cubic are found, and nothing else.
#include "core/curves/all_feet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Where the distance has local minima, by places 1e-3 apart in t and the parabola through the
/// squares at a lowest one and its neighbours. Two minima that are no farther apart are missed.
template <typename C>
std::vector<double> minima_of(const C& curve, const Vec2& point) {
  // So far from the origin as |t| = 6, each curve below is farther from the points than at t = 0.
  constexpr int kPlaces = 6000;
  constexpr double kStep = 1e-3;
  const auto square = [&](int i) { return (curve.position(kStep * i) - point).squaredNorm(); };
  std::vector<double> minima;
  for (int i = -kPlaces; i <= kPlaces; ++i) {
    const double before = square(i - 1);
    const double here = square(i);
    const double after = square(i + 1);
    if (here < before && here <= after) {
      const double bend = before - 2.0 * here + after;
      minima.push_back(kStep * (i + 0.5 * (before - after) / bend));
    }
  }
  return minima;
}

/// Returns of how many of the points more than one foot was found.
template <typename C>
int expect_all_minima(const C& curve, bool has_cusp) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  int several = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec2 point(normal(rng), normal(rng));
    const FootPlaces feet = all_feet(curve, point);
    std::vector<double> found(feet.t.begin(), feet.t.begin() + feet.count);
    std::vector<double> minima = minima_of(curve, point);
    if (has_cusp) {
      // It is a foot of any point. Beside it places are too dense to tell how many minima there
      // are.
      EXPECT_EQ(std::count(found.begin(), found.end(), 0.0), 1) << i;
      const auto at_cusp = [](double t) { return std::abs(t) < 2e-3; };
      found.erase(std::remove_if(found.begin(), found.end(), at_cusp), found.end());
      minima.erase(std::remove_if(minima.begin(), minima.end(), at_cusp), minima.end());
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found.size(), minima.size()) << "point " << i;
    for (std::size_t k = 0; k < std::min(found.size(), minima.size()); ++k) {
      // The parabola leaves out what the square has of the third order in t.
      EXPECT_NEAR(found[k], minima[k], 1e-4) << "point " << i;
    }
    several += minima.size() > 1 ? 1 : 0;
  }
  return several;
}

TEST(AllFeet, AreTheLocalMinimaOfTheDistance) {
  EXPECT_GT(expect_all_minima(CubicalParabola{2.0, -1.5}, false), 20);
  EXPECT_GT(expect_all_minima(SemiCubicalParabola{0.7, 0.4}, true), 20);
  EXPECT_GT(expect_all_minima(CubicSpline{0.7, 0.4, -0.3}, false), 20);
}

/// A spline that is nearly a cubical parabola, 1e7 half extents from its vertex.
TEST(AllFeet, AreFoundFarFromTheVertex) {
  const CubicSpline spline{50834.2, -3.02176e+06, 5.98747e+07};
  constexpr double kMiddle = 19.814;  // of the part that is like a cubical parabola
  for (int i = -20; i <= 20; ++i) {
    const double t = kMiddle + 1e-3 * i;
    const CurveDerivatives at = spline.derivatives(t);
    constexpr double kOff = 1e-3;
    const Vec2 point = at.position + kOff * left_of(at.first).normalized();
    // Places are 6e-8 apart there.
    EXPECT_NEAR(spline.foot_point(point).distance, kOff, 1e-6) << i;
    const FootPlaces feet = all_feet(spline, point);
    const auto nearest =
        std::min_element(feet.t.begin(), feet.t.begin() + feet.count,
                         [&](double u, double v) { return std::abs(u - t) < std::abs(v - t); });
    ASSERT_GT(feet.count, 0U) << i;
    EXPECT_NEAR((*nearest - t) * at.first.norm(), 0.0, 1e-6) << i;
  }
}

/// A point beside an arm is the farther from another one, or the nearer.
TEST(FootAtDistance, IsOnTheArmThatThePointWasSetOffFrom) {
  auto rng = test::test_rng();
  const std::vector<Curve> cubics{CubicalParabola{0.5, -1.0}, SemiCubicalParabola{1.0, 0.3},
                                  CubicSpline{1.0, 0.2, 0.1}};
  int nearer = 0;
  for (int i = 0; i < 3000; ++i) {
    const Curve& curve = cubics[i % cubics.size()];
    const double t = test::uniform(rng, -1.5, 1.5);
    const LocalGeometry local = geometry(curve, t);
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    // Beyond the centre of curvature the place is no nearest one.
    const double most = side * local.kappa > 0.0 ? std::min(1.0, 0.9 / local.kappa * side) : 1.0;
    const double distance = most * test::uniform(rng, 0.1, 1.0);
    const Vec2 normal(-std::sin(local.tangent_angle), std::cos(local.tangent_angle));
    const Vec2 point = position(curve, t) + side * distance * normal;
    const double found = std::abs(foot_at_distance(curve, point, distance, 0.0).distance);
    EXPECT_NEAR(found, distance, 1e-12) << "point " << i;
    nearer += std::abs(foot_point(curve, point).distance) < 0.9 * distance;
  }
  EXPECT_GT(nearer, 100);
}

}  // namespace
}  // namespace palpate
