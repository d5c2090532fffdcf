// Touches in no order, and strokes of few touches, on random known parts: placed as stated, and not
// on parts that they are not of.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/numerics/probability/chi_square.h"
#include "core/part/segment_match.h"
#include "tests/support/closed_spline_part.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigma = 2e-5;

/// Control points all round, 5 to 10 of them, 23 to 47 mm from the middle.
std::vector<Vec2> random_control(std::mt19937_64& rng) {
  const int count = 5 + static_cast<int>(rng() % 6);
  std::vector<Vec2> control;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * (i + test::uniform(rng, -0.25, 0.25)) / count;
    const double radius = test::uniform(rng, 0.023, 0.047);
    control.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return control;
}

ClosedSpline mirrored(std::vector<Vec2> control) {
  for (Vec2& point : control) point.x() = -point.x();
  return ClosedSpline(std::move(control));
}

enum class Given { AsTouches, AsStroke };

struct Touches {
  std::vector<StoredPatch> patches;
  std::vector<double> t;  ///< of every touch, in the order given
};

/// Touches at random places, uniform over this fraction of the part, that begins anywhere. As
/// touches: single ones, in no order. As a stroke: in their order along the part.
Touches touch_at_random(const ClosedSpline& part, const Pose2& pose, int count, double fraction,
                        double noise_m, Given given, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, noise_m);
  const double length = part.arc_length(0.0, static_cast<double>(part.size()));
  const double from = test::uniform(rng, 0.0, length);
  std::vector<double> places;
  for (int i = 0; i < count; ++i) {
    places.push_back(from + test::uniform(rng, 0.0, fraction * length));
  }
  if (given == Given::AsStroke) std::sort(places.begin(), places.end());
  Touches touches;
  for (std::size_t i = 0; i < places.size(); ++i) {
    touches.t.push_back(part.parameter_at_arc_length(0.0, places[i]));
    const double x = noise(rng);
    const double y = noise(rng);
    if (i == 0 || given == Given::AsTouches) {
      touches.patches.emplace_back().context.patch = static_cast<std::uint32_t>(i);
    }
    touches.patches.back().samples.push_back(
        {pose * part.position(touches.t.back()) + Vec2(x, y), kSigma, 1.0});
  }
  return touches;
}

double squared_error(const PartPlacement& placement, const Pose2& truth) {
  const Eigen::Vector3d error(placement.world_T_part.x - truth.x,
                              placement.world_T_part.y - truth.y,
                              wrap_angle(placement.world_T_part.theta - truth.theta));
  return error.dot(placement.covariance.inverse() * error);
}

TEST(TouchesOnPart, ExactOnesInNoOrderArePlacedExactly) {
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(10); ++i) {
    const ClosedSpline part(random_control(rng));
    const Pose2 truth = test::random_pose(rng);
    const Touches touches = touch_at_random(part, truth, 14, 1.0, 0.0, Given::AsTouches, rng);
    const SegmentMatch match = match_segment(part, touches.patches);
    ASSERT_EQ(match.status, SegmentMatchStatus::Determined) << i;
    const PartPlacement& best = match.placements.front();
    EXPECT_NEAR(best.world_T_part.x, truth.x, 1e-9);
    EXPECT_NEAR(best.world_T_part.y, truth.y, 1e-9);
    EXPECT_NEAR(wrap_angle(best.world_T_part.theta - truth.theta), 0.0, 1e-9);
    for (std::size_t k = 0; k < touches.t.size(); ++k) {
      const SamplePlace& place = best.patches[k].samples[0];
      EXPECT_NEAR(std::remainder(touches.t[k] - static_cast<double>(place.segment) - place.u,
                                 static_cast<double>(part.size())),
                  0.0, 1e-7);
    }
  }
}

TEST(TouchesOnPart, TipsLieOutside) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(5); ++i) {
    const Pose2 truth = test::random_pose(rng);
    const test::TouchedPart touched =
        test::touch(part, truth, {{0.3 * i, 0.15, 14}}, 0.0, kSigma, rng, 0.003);
    std::vector<StoredPatch> patches;
    for (const StoredSample& sample : touched.patches[0].samples) {
      StoredPatch& patch = patches.emplace_back();
      patch.context.patch = static_cast<std::uint32_t>(patches.size());
      patch.context.tip_radius_m = 0.003;
      patch.samples = {sample};
    }
    std::shuffle(patches.begin(), patches.end(), rng);
    const SegmentMatch match = match_segment(part, patches);
    ASSERT_EQ(match.status, SegmentMatchStatus::Determined) << i;
    EXPECT_NEAR(match.placements[0].world_T_part.x, truth.x, 1e-9);
    EXPECT_NEAR(match.placements[0].world_T_part.y, truth.y, 1e-9);
  }
}

/// The answer is that of any other order of the touches, and of the same touches as one stroke.
TEST(TouchesOnPart, TheirOrderDoesNotMatter) {
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(10); ++i) {
    const ClosedSpline part(random_control(rng));
    // Over a fifth of the part several placements are left, whose masses are compared.
    Touches touches = touch_at_random(part, test::random_pose(rng), 6, i % 2 == 0 ? 1.0 : 0.2,
                                      kSigma, Given::AsTouches, rng);
    const SegmentMatch a = match_segment(part, touches.patches);
    std::shuffle(touches.patches.begin(), touches.patches.end(), rng);
    const SegmentMatch b = match_segment(part, touches.patches);
    StoredPatch stroke;
    for (const StoredPatch& touch : touches.patches) stroke.samples.push_back(touch.samples[0]);
    const SegmentMatch c = match_segment(part, std::span(&stroke, 1));
    ASSERT_FALSE(a.placements.empty()) << i;
    for (const SegmentMatch* other : {&b, &c}) {
      ASSERT_FALSE(other->placements.empty()) << i;
      EXPECT_NEAR(a.placements[0].chi2, other->placements[0].chi2, 1e-4) << i;
      // The trapezoid is right to 2 %, on either side of the odds.
      EXPECT_NEAR(a.placements[0].probability, other->placements[0].probability, 0.01) << i;
    }
  }
}

TEST(TouchesOnPart, ASymmetricPartIsAmbiguous) {
  auto rng = test::test_rng();
  for (const int points : {4, 5, 6}) {
    const ClosedSpline part = test::symmetric_part(points);
    const Touches touches =
        touch_at_random(part, test::random_pose(rng), 12, 0.4, 0.0, Given::AsTouches, rng);
    const SegmentMatch match = match_segment(part, touches.patches);
    ASSERT_EQ(match.status, SegmentMatchStatus::Ambiguous) << points;
    EXPECT_EQ(match.doubt, SegmentMatchDoubt::SeveralPlacements);
    ASSERT_GE(match.placements.size(), static_cast<std::size_t>(points));
    for (int i = 1; i < points; ++i) {
      EXPECT_NEAR(match.placements[static_cast<std::size_t>(i)].probability,
                  match.placements[0].probability, 0.05);
    }
  }
}

TEST(TouchesOnPart, TooLittleSaysNothing) {
  const ClosedSpline part = test::paper_part();
  std::vector<StoredPatch> patches(8);
  for (StoredPatch& patch : patches) patch.samples = {{{0.1, 0.2}, kSigma, 1.0}};
  EXPECT_EQ(match_segment(part, patches).status, SegmentMatchStatus::TooFewSamples);  // one place
  auto rng = test::test_rng();
  Touches touches = touch_at_random(part, {}, 3, 1.0, kSigma, Given::AsTouches, rng);
  EXPECT_EQ(match_segment(part, touches.patches).status, SegmentMatchStatus::TooFewSamples);
  // Nothing shows the noise of single touches that state none.
  touches = touch_at_random(part, {}, 12, 1.0, kSigma, Given::AsTouches, rng);
  for (StoredPatch& patch : touches.patches) patch.samples[0].sigma_m = 0.0;
  const SegmentMatch match = match_segment(part, touches.patches);
  EXPECT_EQ(match.status, SegmentMatchStatus::TooFewSamples);
  EXPECT_EQ(match.sigma_m, 0.0);
}

/// Statuses, posteriors and covariances must be true. Prints the results.
void expect_true_answers(const char* name, int least, int most, double fraction, Given given) {
  auto rng = test::test_rng();
  const int count = test::stress_count(100);
  // Another placement is hundreds of standard deviations away.
  constexpr double kAnother = 100.0;
  int no_match = 0;
  int determined = 0;
  int wrong = 0;
  double wrong_stated = 0.0;
  int best_wrong = 0;
  double best_stated = 0.0;
  double best_variance = 0.0;
  double squares = 0.0;
  for (int i = 0; i < count; ++i) {
    const ClosedSpline part(random_control(rng));
    const Pose2 truth = test::random_pose(rng);
    const int touches = least + i % (most - least + 1);
    const SegmentMatch match = match_segment(
        part, touch_at_random(part, truth, touches, fraction, kSigma, given, rng).patches);
    EXPECT_NE(match.status, SegmentMatchStatus::TooFewSamples) << i;
    no_match += match.status == SegmentMatchStatus::NoMatch;
    if (match.placements.empty()) continue;
    const PartPlacement& best = match.placements.front();
    const double square = squared_error(best, truth);
    for (std::size_t a = 0; a < match.placements.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        // One placement counts once: less than a hundredth of a deviation apart is the same.
        EXPECT_GT(squared_error(match.placements[b], match.placements[a].world_T_part), 1e-4) << i;
      }
    }
    if (match.status == SegmentMatchStatus::Determined) {
      ++determined;
      wrong += square > kAnother;
      wrong_stated += 1.0 - best.probability;
      squares += square > kAnother ? 0.0 : square;
    }
    // Where the part slides, a placement is a valley and has no covariance to measure by.
    if (match.doubt != SegmentMatchDoubt::SlidesAlong && best.nonlinearity < 0.5) {
      best_wrong += square > kAnother;
      best_stated += 1.0 - best.probability;
      best_variance += best.probability * (1.0 - best.probability);
    }
  }
  const int right = determined - wrong;
  std::printf(
      "%s: %d trials, no match %d, determined %d, of these wrong %d (stated %.2f); most probable "
      "wrong %d (stated %.2f); mean squared error %.2f (law 3)\n",
      name, count, no_match, determined, wrong, wrong_stated, best_wrong, best_stated,
      right > 0 ? squares / right : 0.0);
  EXPECT_LE(no_match, test::most_of_poisson(SegmentMatchOptions{}.significance * count));
  EXPECT_LE(wrong, test::most_of_poisson(wrong_stated));
  if (!test::counts_tell()) return;
  EXPECT_NEAR(best_wrong, best_stated, 4.0 * std::sqrt(best_variance) + 1.0);
  if (right >= 30) {
    EXPECT_NEAR(squares / right, 3.0, 4.0 * std::sqrt(6.0 / right));
  }
}

TEST(TouchesOnPart, AllRoundArePlaced) {
  expect_true_answers("touches all round", 8, 20, 1.0, Given::AsTouches);
}
TEST(TouchesOnPart, OverAPieceArePlaced) {
  expect_true_answers("touches over 0.4", 6, 20, 0.4, Given::AsTouches);
}
TEST(TouchesOnPart, FewMayLieSeveralWays) {
  expect_true_answers("4 to 6 touches", 4, 6, 0.5, Given::AsTouches);
}
TEST(TouchesOnPart, SparseStrokesArePlaced) {
  expect_true_answers("strokes of 8 to 15 all round", 8, 15, 1.0, Given::AsStroke);
}

/// Of another part, or of the mirrored one. Where the part fits them but for less than the test can
/// tell, no answer can know better.
void expect_no_match(Given given) {
  // Chi-square with at most 17 degrees of freedom is tested at 5e-4, a threshold of 42. With this
  // noncentrality its mean is 167 and its standard deviation 25: five of them.
  constexpr double kTold = 150.0;
  auto rng = test::test_rng();
  int told = 0;
  const int count = test::stress_count(40);
  for (int i = 0; i < count; ++i) {
    const std::vector<Vec2> control = random_control(rng);
    const ClosedSpline part(control);
    const ClosedSpline touched = i % 2 == 0 ? mirrored(control) : ClosedSpline(random_control(rng));
    const Pose2 pose = test::random_pose(rng);
    const int touches = 8 + i % 13;
    auto same = rng;
    const SegmentMatch exact =
        match_segment(part, touch_at_random(touched, pose, touches, 1.0, 0.0, given, same).patches);
    const SegmentMatch match = match_segment(
        part, touch_at_random(touched, pose, touches, 1.0, kSigma, given, rng).patches);
    ASSERT_FALSE(exact.placements.empty()) << i;
    double least = exact.placements[0].chi2;
    for (const PartPlacement& placement : exact.placements) least = std::min(least, placement.chi2);
    if (least > kTold) {
      ++told;
      EXPECT_EQ(match.status, SegmentMatchStatus::NoMatch) << i << ", difference " << least;
    }
  }
  std::printf("%d of %d differ visibly\n", told, count);
  if (!test::counts_tell()) return;
  EXPECT_GE(told, count / 2);  // or the test says nothing
}

TEST(TouchesOnPart, ThoseOfAnotherPartAreNoMatch) { expect_no_match(Given::AsTouches); }
TEST(TouchesOnPart, SparseStrokesOfAnotherPartAreNoMatch) { expect_no_match(Given::AsStroke); }

// As if its file, or the samples', were read in another unit. Neighbouring placements then end in
// different valleys, however near they are, and each leads to a next one: it took a minute.
TEST(TouchesOnPart, OfAPartFarLargerOrSmallerAreNoMatch) {
  auto rng = test::test_rng();
  for (const double factor : {25.4, 10.0, 0.1, 1.0 / 25.4}) {
    for (int i = 0; i < test::stress_count(4); ++i) {
      const ClosedSpline part(random_control(rng));
      const Touches touches = touch_at_random(part, Pose2{0.1, -0.3, 0.7}, 60, 0.6, 1e-5,
                                              i % 2 == 0 ? Given::AsTouches : Given::AsStroke, rng);
      EXPECT_EQ(match_segment(part.scaled(1.0 / factor), touches.patches).status,
                SegmentMatchStatus::NoMatch)
          << factor;
    }
  }
}

}  // namespace
}  // namespace palpate
