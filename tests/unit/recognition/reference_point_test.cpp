#include "core/recognition/modes/reference_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate {
namespace {

using Strokes = std::vector<std::vector<Vec2>>;

FitData data_of(const Strokes& strokes) {
  FitData data;
  for (const std::vector<Vec2>& stroke : strokes) {
    const std::size_t begin = data.points.size();
    for (const Vec2& place : stroke) {
      FitPoint point;
      point.position = place;
      data.points.push_back(point);
    }
    data.patches.push_back({begin, data.points.size()});
  }
  return data;
}

Vec2 reference_of(const Strokes& strokes) {
  const FitData data = data_of(strokes);
  return data.points[reference_point(data)].position;
}

/// On the unit circle, so many places from one angle to another.
std::vector<Vec2> arc(double from, double to, int count) {
  std::vector<Vec2> places;
  for (int i = 0; i < count; ++i) {
    const double t = from + (to - from) * i / (count - 1);
    places.emplace_back(std::cos(t), std::sin(t));
  }
  return places;
}

TEST(ReferencePoint, IsInTheMiddleOfTheLongestStrokeHoweverManyPointsItHas) {
  const Vec2 middle = reference_of({arc(0.0, 0.5, 30), arc(1.0, 2.0, 9), arc(3.0, 3.2, 50)});
  EXPECT_NEAR((middle - Vec2(std::cos(1.5), std::sin(1.5))).norm(), 0.0, 1e-12);
}

// A cusp: y^2 = x^3, touched over it.
TEST(ReferencePoint, IsNotAtACusp) {
  std::vector<Vec2> over;
  for (int i = -10; i <= 12; ++i) {
    const double t = 0.1 * i;
    over.emplace_back(t * t, t * t * t);
  }
  const Vec2 place = reference_of({over});
  EXPECT_GT(place.x(), 0.3);  // in the middle of the longer arm, which ends at 1.44
  EXPECT_GT(place.y(), 0.0);
}

TEST(ReferencePoint, DoesNotDependOnTheOrderOfTouching) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> uniform(0.0, 6.0);
  for (int scene = 0; scene < 200; ++scene) {
    Strokes strokes;
    for (int p = 0; p < 4; ++p) {
      const double from = uniform(rng);
      strokes.push_back(arc(from, from + 0.7, 8 + scene % 2));  // of one length but for rounding
    }
    const Vec2 place = reference_of(strokes);
    for (int order = 0; order < 6; ++order) {
      std::shuffle(strokes.begin(), strokes.end(), rng);
      std::reverse(strokes[0].begin(), strokes[0].end());
      std::reverse(strokes[2].begin(), strokes[2].end());
      EXPECT_EQ(reference_of(strokes), place) << scene;
    }
  }
}

TEST(ReferencePoint, OfTouchesThatLieApartIsTheOneInTheirMidst) {
  EXPECT_EQ(reference_of({{{0.0, 0.0}}, {{5.0, 1.0}}, {{2.0, 0.5}}, {}}), Vec2(2.0, 0.5));
}

}  // namespace
}  // namespace palpate
