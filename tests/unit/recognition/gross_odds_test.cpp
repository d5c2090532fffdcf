// The odds against gross errors of touches.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "core/recognition/counted/gross_touches.h"
#include "core/recognition/samples/fit_data.h"
#include "tests/support/scene_data.h"

namespace palpate {
namespace {

/// A touch, a stroke of five samples, and three touches more.
FitData touches_and_a_stroke() {
  test::Scene scene;
  scene.patches = {{Vec2(0.0, 0.0)},
                   {Vec2(1.0, 0.0), Vec2(1.1, 0.0), Vec2(1.2, 0.0), Vec2(1.3, 0.0), Vec2(1.4, 0.0)},
                   {Vec2(0.0, 1.0)},
                   {Vec2(1.0, 1.0)},
                   {Vec2(2.0, 1.0)}};
  return test::fit_data(scene, 1e-3);
}

/// Points with these numbers set aside, each patch where it was.
FitData set_aside(const FitData& data, std::initializer_list<std::size_t> gone) {
  std::vector<bool> is_out(data.points.size(), false);
  for (const std::size_t i : gone) {
    is_out[i] = true;
  }
  return without_points(data, is_out);
}

TEST(GrossOdds, AreOfTouchesAloneAndOfEachOfThem) {
  const FitData data = touches_and_a_stroke();
  ASSERT_EQ(data.patches.size(), 5U);
  // One touch in a hundred, as the source says.
  const double of_one = std::log(99.0);
  EXPECT_EQ(log_odds_against_gross(data, data), 0.0);
  EXPECT_NEAR(log_odds_against_gross(data, set_aside(data, {0})), of_one, 1e-12);
  EXPECT_NEAR(log_odds_against_gross(data, set_aside(data, {6, 8})), 2.0 * of_one, 1e-12);
  // A spike of a stroke has odds of its own, even if the stroke is lost by them.
  EXPECT_EQ(log_odds_against_gross(data, set_aside(data, {3})), 0.0);
  EXPECT_EQ(log_odds_against_gross(data, set_aside(data, {1, 2, 3, 4, 5})), 0.0);
  EXPECT_NEAR(log_odds_against_gross(data, set_aside(data, {2, 7})), of_one, 1e-12);
}

}  // namespace
}  // namespace palpate
