#include "core/recognition/samples/tips/strokes_together.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/recognition/samples/tips/tip_sides.h"

namespace palpate {
namespace {

constexpr double kTipRadius = 0.1;
constexpr double kNoiseOfCentre = 1e-4;

struct TipStrokes {
  std::vector<StoredPatch> patches;
  FitData centres;

  /// Centres of a tip on a path, 10 from `from` to `to`.
  TipStrokes& add(const std::function<Vec2(double)>& path, double from, double to,
                  double radius = kTipRadius) {
    constexpr int kCentres = 10;
    StoredPatch patch;
    patch.context.patch = static_cast<std::uint32_t>(patches.size());
    patch.context.tip_radius_m = radius;
    PatchSpan span{centres.points.size(), centres.points.size()};
    for (int i = 0; i < kCentres; ++i) {
      const double t = from + (to - from) * i / (kCentres - 1);
      const double step = 1e-6 * (to - from);
      FitPoint point;
      point.position = path(t);
      point.tangent = (path(t + step) - path(t - step)).normalized();
      point.inverse_sigma = 1.0 / kNoiseOfCentre;
      point.offset = radius;
      centres.points.push_back(point);
      patch.samples.push_back({point.position, kNoiseOfCentre});
      ++span.end;
    }
    centres.patches.push_back(span);
    patches.push_back(std::move(patch));
    return *this;
  }

  std::vector<Alongside> together() const {
    WorkBudget work;
    return strokes_together(patches, centres, work);
  }

  std::vector<std::vector<int>> ways() const {
    WorkBudget work;
    return possible_sides(patches, centres, turns_of(centres), {}, work).ways;
  }
};

Vec2 over_an_ellipse(double t) { return {std::cos(t), 0.7 * std::sin(t)}; }

TEST(StrokesTogether, BothWaysAlongOneWall) {
  const auto strokes =
      TipStrokes().add(over_an_ellipse, 0.0, 2.0).add(over_an_ellipse, 2.5, 0.5).together();
  EXPECT_EQ(strokes[1].first, 0U);
  EXPECT_EQ(strokes[1].sense, -1);
}

TEST(StrokesTogether, AChainRunsTogether) {
  // The first and the last have no place in common, and are compared before either is with the
  // middle.
  const auto strokes = TipStrokes()
                           .add(over_an_ellipse, 0.0, 1.0)
                           .add(over_an_ellipse, 3.0, 1.8)
                           .add(over_an_ellipse, 2.6, 0.4)
                           .together();
  for (const Alongside& stroke : strokes) EXPECT_EQ(stroke.first, 0U);
  EXPECT_EQ(strokes[1].sense, -1);
  EXPECT_EQ(strokes[2].sense, -1);
}

TEST(StrokesTogether, OthersRunAlone) {
  const auto line = [](double y, double slope) {
    return [y, slope](double t) { return Vec2(t, y + slope * t); };
  };
  // The two walls of a groove with a clearance of a fifth of the radius; paths that cross; another
  // tip; another place.
  const auto expect_alone = [](const TipStrokes& strokes) {
    const auto together = strokes.together();
    EXPECT_EQ(together[0].first, 0U);
    EXPECT_EQ(together[1].first, 1U);
  };
  expect_alone(
      TipStrokes().add(line(0.0, 0.0), -1.0, 1.0).add(line(0.2 * kTipRadius, 0.0), 1.0, -1.0));
  expect_alone(TipStrokes().add(line(0.0, 0.0), -1.0, 1.0).add(line(0.0, 0.3), -1.0, 1.0));
  expect_alone(
      TipStrokes().add(over_an_ellipse, 0.0, 2.0).add(over_an_ellipse, 0.0, 2.0, 0.5 * kTipRadius));
  expect_alone(TipStrokes().add(over_an_ellipse, 0.0, 1.0).add(over_an_ellipse, 2.0, 3.0));
}

TEST(StrokesTogether, OneKnownSideHoldsForAll) {
  TipStrokes strokes;
  strokes.add(over_an_ellipse, 0.0, 2.0)
      .add(over_an_ellipse, 2.5, 0.5)
      .add(over_an_ellipse, 5.0, 4.0);
  EXPECT_EQ(strokes.ways().size(), 4U);                           // the third runs alone
  strokes.patches[0].context.material_side = MaterialSide::Left;  // the tip on the right
  for (const auto& way : strokes.ways()) {
    EXPECT_EQ(way[0], -1);
    EXPECT_EQ(way[1], 1);
  }
  EXPECT_EQ(strokes.ways().size(), 2U);
}

TEST(StrokesTogether, TheSurestBendHoldsForAll) {
  // A stroke so short that it does not show which way it bends, beside a long one against it.
  TipStrokes strokes;
  strokes.add(over_an_ellipse, 1.0, 1.3).add(over_an_ellipse, 2.5, 0.0);
  for (FitPoint& point : strokes.centres.points) {
    if (&point < &strokes.centres.points[10]) point.tangent = Vec2(-1.0, 1e-9).normalized();
  }
  const auto ways = strokes.ways();
  ASSERT_EQ(ways.size(), 2U);
  EXPECT_EQ(ways[0], (std::vector<int>{-1, 1}));  // outside the long one's bend
  EXPECT_EQ(ways[1], (std::vector<int>{1, -1}));
}

}  // namespace
}  // namespace palpate
