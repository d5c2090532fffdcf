// The nearest node by circles is the nearest of all.
#include "core/part/nearest_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

double least_distance(const std::vector<Vec2>& nodes, const Vec2& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2& node : nodes) least = std::min(least, (node - point).norm());
  return least;
}

TEST(NearestNode, IsTheNearestOfAll) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 63U, 64U, 65U, 240U, 1000U}) {
    std::vector<Vec2> walk;
    Vec2 at = Vec2::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      at += Vec2(normal(rng), normal(rng));
      walk.push_back(at);
    }
    const NearestNode nearest(walk);
    for (int i = 0; i < test::stress_count(500); ++i) {
      const double reach = i % 2 == 0 ? 3.0 : 100.0;
      const Vec2 point = walk[i % count] + reach * Vec2(normal(rng), normal(rng));
      EXPECT_EQ((walk[nearest.to(point)] - point).norm(), least_distance(walk, point));
    }
    EXPECT_EQ(walk[nearest.to(walk.back())], walk.back());
  }
}

TEST(NearestNode, AnyNodeWhereNoneIsNearer) {
  const double infinite = std::numeric_limits<double>::infinity();
  const NearestNode same(std::vector<Vec2>(100, Vec2(1.0, 2.0)));
  EXPECT_LT(same.to({5.0, 5.0}), 100U);
  const NearestNode far({{1e300, -1e300}, {-1e300, 1e300}, {0.0, 0.0}});
  EXPECT_LT(far.to({infinite, 0.0}), 3U);
  EXPECT_EQ(far.to({0.1, 0.1}), 2U);
}

}  // namespace
}  // namespace palpate
