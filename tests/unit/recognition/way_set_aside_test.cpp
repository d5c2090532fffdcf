#include "core/recognition/counted/way_set_aside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace palpate {
namespace {

constexpr double kNoise_m = 1e-5;

/// A stroke along the x axis, the last samples of which are off it by so many deviations, and set
/// aside. `tip_radius_m`: then they are those of a tip's centre.
bool leads_away(const std::vector<double>& last, bool reversed = false, double tip_radius_m = 0.0) {
  const ExplainingCurve axis{{CurveClass::Line, {}}, Pose2{}, kNoise_m};
  StoredPatch patch;
  patch.context.tip_radius_m = tip_radius_m;
  std::vector<double> off(8, 0.0);
  off.insert(off.end(), last.begin(), last.end());
  std::vector<bool> aside;
  for (std::size_t i = 0; i < off.size(); ++i) {
    patch.samples.push_back(
        {{1e-3 * static_cast<double>(i), tip_radius_m + kNoise_m * off[i]}, kNoise_m});
    aside.push_back(off[i] != 0.0);
  }
  if (reversed) {
    std::reverse(patch.samples.begin(), patch.samples.end());
    std::reverse(aside.begin(), aside.end());
  }
  return has_way_set_aside(std::vector{patch}, aside, axis);
}

TEST(WaySetAside, IsThreeThatLeadAway) {
  for (const double side : {1.0, -1.0}) {
    for (const bool reversed : {false, true}) {
      for (const double tip_radius_m : {0.0, 2e-3}) {
        EXPECT_TRUE(leads_away({side * 10, side * 40, side * 90}, reversed, tip_radius_m));
        // Noise may bring one nearer than the one before.
        EXPECT_TRUE(leads_away({side * 10, side * 12, side * 11}, reversed, tip_radius_m));
        EXPECT_TRUE(leads_away({side * -9, side * 10, side * 40, side * 90}, reversed));
      }
    }
  }
}

TEST(WaySetAside, IsFourOnOneSide) {
  EXPECT_TRUE(leads_away({90, 50, 70, 60}));
  EXPECT_FALSE(leads_away({90, -50, 70, 60}));
}

TEST(WaySetAside, SpikesAreNone) {
  EXPECT_FALSE(leads_away({}));
  EXPECT_FALSE(leads_away({40, 90}));
  EXPECT_FALSE(leads_away({10, -40, 90}));
  EXPECT_FALSE(leads_away({90, 40, 10}));
  EXPECT_FALSE(leads_away({10, 40, 90, 0}));  // they come back
}

}  // namespace
}  // namespace palpate
