// Directions of tips' centres that no polynomial follows, from edges that all of them lie on.
#include "core/recognition/weigh/tip_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/edges.h"
#include "core/recognition/smooth/arcs.h"
#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigmaOverSpacing = 1e-3;  // over the spacing of samples
constexpr double kAnyChi2 = 1e300;

/// Centres of a tip that rolls about a corner, an arc of this radius, from one edge to the other.
StoredPatch rolled(const RoundedCorner& corner, bool turned, std::mt19937_64& rng) {
  StoredPatch patch;
  patch.context.tip_radius_m = corner.radius;
  const double half_arc = corner.radius * corner.half_turn;
  for (double s = -half_arc - test::uniform(rng, 15.0, 30.0);
       s < half_arc + test::uniform(rng, 15.0, 30.0); s += 1.0) {
    const double angle = std::clamp(s / corner.radius, -corner.half_turn, corner.half_turn);
    const double direction = corner.bisector + angle;
    const Vec2 normal(std::cos(direction), std::sin(direction));
    const Vec2 place =
        corner.centre + corner.radius * normal + (s - corner.radius * angle) * left_of(normal);
    patch.samples.push_back({place + test::normal_pair(rng, kSigmaOverSpacing), kSigmaOverSpacing});
  }
  if (turned) {
    std::reverse(patch.samples.begin(), patch.samples.end());
  }
  return patch;
}

/// By how many of its stated deviations the worst direction is off: of kept points, in the travel
/// that the samples have.
double worst_of(const FitData& touches, const SmoothModel& smooth, const RoundedCorner& corner,
                const std::vector<double>& travel) {
  double worst = 0.0;
  std::size_t p = 0;
  for (const ReducedSection& section : smooth.sections) {
    while (section.begin >= touches.patches[p].end) {
      ++p;
    }
    for (std::size_t i = section.begin; section.kept && i < section.end; ++i) {
      const FitPoint& point = touches.points[i];
      const Vec2 world = touches.frame * (touches.scale * point.position);
      const Vec2 truth = travel[p] * touches.frame.rotate_back(corner.tangent(world));
      worst = std::max(worst, turn_between(truth, point.tangent) == 0.0
                                  ? 0.0
                                  : std::abs(turn_between(truth, point.tangent)) /
                                        std::min(point.tangent_sigma, 1.0));
    }
  }
  return worst;
}

TEST(TipDirections, EdgesTellThemWhereChordsLeadRoundTheBend) {
  std::mt19937_64 rng = test::test_rng();
  int misled = 0;
  int kept = 0;
  const int scenes = test::stress_count(40);
  for (int i = 0; i < scenes; ++i) {
    const RoundedCorner corner{{test::uniform(rng, -30.0, 30.0), test::uniform(rng, -30.0, 30.0)},
                               test::uniform(rng, -kPi, kPi),
                               test::uniform(rng, 0.4, 1.2),
                               test::uniform(rng, 0.3, 2.0)};
    std::vector<StoredPatch> patches;
    std::vector<double> travel;
    for (int p = 0; p < 2; ++p) {
      const bool turned = test::random_sign(rng) < 0.0;
      patches.push_back(rolled(corner, turned, rng));
      travel.push_back(turned ? -1.0 : 1.0);
    }
    FitData data = make_fit_data(patches, 0.0);
    const Arcs arcs = smooth_arcs(std::move(data));
    WorkBudget work;
    const auto edges = edges_of(arcs, kAnyChi2, work);
    ASSERT_TRUE(edges.has_value()) << i;
    ASSERT_TRUE(fits_well(edges->chi2, residual_count(arcs.data))) << i << ": " << edges->chi2;
    FitData touches = arcs.smooth.reduced;
    if (!has_kept_tips(arcs.smooth)) {
      continue;
    }
    ++kept;
    misled += worst_of(touches, arcs.smooth, corner, travel) > 0.1 ? 1 : 0;
    const std::vector<double> bends = tell_directions(edges->corner, arcs.smooth, &touches, work);
    EXPECT_LE(worst_of(touches, arcs.smooth, corner, travel), kNegligibleDeviations) << i;
    ASSERT_EQ(bends.size(), travel.size());
    for (std::size_t p = 0; p < bends.size(); ++p) {
      EXPECT_EQ(bends[p], travel[p]) << i << ", patch " << p;
    }
  }
  if (test::counts_tell()) {
    EXPECT_GT(misled, 0) << "of " << kept;  // else there was nothing to tell
  }
}

}  // namespace
}  // namespace palpate
