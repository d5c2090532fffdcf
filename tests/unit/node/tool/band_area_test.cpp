#include "node/tool/drawing/band_area.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

/// A circle of radius 1, to the left of which its centre lies.
DrawnCurve circle(double left_m, double right_m) {
  DrawnCurve curve;
  curve.closed = true;
  constexpr int kPieces = 240;
  for (int i = 0; i <= kPieces; ++i) {
    const double t = 2.0 * kPi * i / kPieces;
    CurvePlace place;
    place.position = {std::cos(t), std::sin(t)};
    place.left = -place.position;
    place.band = BandWidth{left_m, right_m};
    curve.places.push_back(place);
  }
  return curve;
}

/// By crossings of a ray, as SVG's evenodd; of a polygon that crosses itself once it is nonzero
/// too.
bool covers(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool is_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
      is_inside = !is_inside;
    }
  }
  return is_inside;
}

bool covers(const std::vector<std::vector<Vec2>>& area, const Vec2& p) {
  for (const std::vector<Vec2>& polygon : area) {
    if (covers(polygon, p)) return true;
  }
  return false;
}

TEST(BandArea, OfANarrowBandIsOnePolygonBesideTheCurve) {
  const auto area = band_area(circle(0.2, -0.1));
  ASSERT_EQ(area.size(), 1U);
  EXPECT_TRUE(covers(area, {0.81, 0.01}));
  EXPECT_TRUE(covers(area, {1.09, 0.01}));
  EXPECT_FALSE(covers(area, {0.79, 0.01}));
  EXPECT_FALSE(covers(area, {1.11, 0.01}));
}

TEST(BandArea, OfABandWiderThanTheRadiusIsAllThatLiesBesideTheCurve) {
  const auto area = band_area(circle(1.5, -2.0));
  for (const double radius : {0.01, 0.3, 0.6, 0.9, 1.1, 2.9}) {
    for (const double angle : {0.1, 1.7, 3.3, 5.1}) {
      EXPECT_TRUE(covers(area, Vec2(radius * std::cos(angle), radius * std::sin(angle))))
          << radius << " " << angle;
    }
  }
  EXPECT_FALSE(covers(area, {3.1, 0.0}));
}

TEST(BandArea, WithoutABandIsNone) {
  DrawnCurve curve = circle(0.1, -0.1);
  curve.places[7].band.reset();
  EXPECT_TRUE(band_area(curve).empty());
}

}  // namespace
}  // namespace palpate
