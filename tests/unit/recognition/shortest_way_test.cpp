// The order of touches by the shortest way through them: told where there is no doubt of it.
#include "core/recognition/touches/shortest_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Places at these parameters, in another order, noise across and along.
template <typename PlaceOf>
std::vector<Vec2> places_of(std::vector<double>* t, const PlaceOf& place_of, double sigma,
                            std::mt19937_64& rng) {
  std::shuffle(t->begin(), t->end(), rng);
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<Vec2> places;
  for (const double at : *t) {
    const double y = noise(rng);
    places.push_back(place_of(at) + Vec2(noise(rng), y));
  }
  return places;
}

std::vector<double> spread(int count, double from, double to, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> anywhere(from, to);
  std::vector<double> t;
  for (int i = 0; i < count; ++i) t.push_back(anywhere(rng));
  return t;
}

Vec2 on_circle(double t) { return {std::cos(t), std::sin(t)}; }

TEST(ShortestWay, HasTouchesOfAnArcInTheirOrderAndItsDirections) {
  std::mt19937_64 rng = test::test_rng();
  for (const int count : {60, 200, 1000}) {
    std::vector<double> t = spread(count, 0.3, 2.8, rng);
    const double sigma = 1e-4;
    const auto way = shortest_way(places_of(&t, on_circle, sigma, rng), 20.0 * sigma);
    ASSERT_TRUE(way) << count;
    ASSERT_EQ(way->size(), t.size());
    const double sense = t[way->back().place] > t[way->front().place] ? 1.0 : -1.0;
    for (std::size_t i = 0; i < way->size(); ++i) {
      const OnWay& here = (*way)[i];
      if (i > 0) {
        // Feet that noise may exchange are no nearer than some deviations of it.
        EXPECT_GT(sense * (t[here.place] - t[(*way)[i - 1].place]), -10.0 * sigma) << count;
      }
      const double direction = t[here.place] + sense * 0.5 * kPi;
      EXPECT_LT(std::abs(std::remainder(here.angle - direction, 2.0 * kPi)), 0.2) << count;
      // Noise turns a step of 0.02 by a hundredth.
      EXPECT_GT(sense * here.turn, -0.05) << count;
    }
    EXPECT_NEAR(std::abs(way->back().angle - way->front().angle),
                std::abs(t[way->back().place] - t[way->front().place]), 0.4)
        << count;
  }
}

TEST(ShortestWay, IsOpenAtTheWidestGapOfAClosedCurve) {
  std::mt19937_64 rng = test::test_rng();
  std::vector<double> t = spread(300, 0.3, 2.0 * kPi, rng);
  const auto way = shortest_way(places_of(&t, on_circle, 1e-4, rng), 2e-3);
  ASSERT_TRUE(way);
  const auto [least, most] = std::minmax_element(t.begin(), t.end());
  const double first = t[way->front().place];
  const double last = t[way->back().place];
  EXPECT_NEAR(std::min(first, last), *least, 1e-3);
  EXPECT_NEAR(std::max(first, last), *most, 1e-3);
}

/// Two arcs at opposite sides of an ellipse: from the end of one it is as far to either end of the
/// other, and the way may go on from the wrong one. The gap is told, and no other.
TEST(ShortestWay, TellsAGapOverWhichItMayGoOnFromAnotherEnd) {
  std::mt19937_64 rng = test::test_rng();
  const auto on_ellipse = [](double at) { return Vec2(std::cos(at), 0.67 * std::sin(at)); };
  for (const int count : {60, 240, 600}) {
    std::vector<double> t = spread(count / 2, 0.0, 1.3, rng);
    const std::vector<double> opposite = spread(count / 2, 3.1, 4.4, rng);
    t.insert(t.end(), opposite.begin(), opposite.end());
    const auto way = shortest_way(places_of(&t, on_ellipse, 5e-4, rng), 1e-2);
    ASSERT_TRUE(way) << count;
    for (std::size_t i = 1; i < way->size(); ++i) {
      const bool across = (t[(*way)[i].place] > 2.0) != (t[(*way)[i - 1].place] > 2.0);
      EXPECT_TRUE(!across || (*way)[i].after_gap) << count;
    }
    // Of places spread by chance, one step in 1,800 is as wide (e^7.5): two of these at most.
    EXPECT_LE(std::count_if(way->begin(), way->end(), [](const OnWay& o) { return o.after_gap; }),
              3)
        << count;
  }
}

TEST(ShortestWay, IsNotToldWhereArmsLieCloseOrNoiseIsAsLargeAsTheSteps) {
  std::mt19937_64 rng = test::test_rng();
  const double sigma = 1e-4;
  std::vector<double> t = spread(300, -1.0, 1.0, rng);
  // A needle that its steps take for one edge.
  const auto needle = [](double at) { return Vec2(2.0 * std::abs(at), at > 0.0 ? 0.006 : -0.006); };
  EXPECT_FALSE(shortest_way(places_of(&t, needle, sigma, rng), 20.0 * sigma));
  EXPECT_FALSE(shortest_way(places_of(&t, on_circle, 0.3, rng), 20.0 * 0.3));
  std::vector<Vec2> anywhere;
  std::uniform_real_distribution<double> law(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const double y = law(rng);
    anywhere.emplace_back(law(rng), y);
  }
  EXPECT_FALSE(shortest_way(anywhere, 20.0 * sigma));
  EXPECT_FALSE(shortest_way(std::vector<Vec2>(40, Vec2(0.1, 0.2)), 0.0));
}

/// No way through points is shorter than their tree; through those of a line it is as long.
TEST(ShortestTree, IsAsLongAsALineAndNoLongerThanAnyWay) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> law(-1.0, 1.0);
  std::vector<Vec2> line;
  std::vector<Vec2> anywhere;
  for (int i = 0; i < 50; ++i) {
    const double y = law(rng);
    anywhere.emplace_back(law(rng), y);
    line.emplace_back(0.6 * y, 0.8 * y);
  }
  EXPECT_LE(shortest_tree(anywhere), length_of(anywhere));
  std::sort(line.begin(), line.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
  EXPECT_NEAR(shortest_tree(line), length_of(line), 1e-12);
}

}  // namespace
}  // namespace palpate
