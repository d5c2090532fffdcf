// Placements on a known part under motions, reversal and reordering, and against their stated
// probabilities.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/numerics/probability/chi_square.h"
#include "core/part/segment_belonging.h"
#include "core/part/segment_match.h"
#include "tests/support/closed_spline_part.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigma = 2e-5;

/// A stroke from a random place on the part, uniform in arc length, in either direction.
test::PartStroke random_stroke(const ClosedSpline& part, double arc_m, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> place(0.0, part.arc_length(0.0, 5.0));
  const double t0 = part.parameter_at_arc_length(0.0, place(rng));
  return {t0, rng() % 2 == 0 ? arc_m : -arc_m};
}

/// Strokes of these lengths anywhere on the part at a random pose. The draws are separate
/// statements, because the compiler chooses the order of arguments.
test::TouchedPart touch_anywhere(const ClosedSpline& part, const std::vector<double>& arcs_m,
                                 std::mt19937_64& rng) {
  std::vector<test::PartStroke> strokes;
  for (const double arc_m : arcs_m) {
    strokes.push_back(random_stroke(part, arc_m, rng));
  }
  const Pose2 world_T_part = test::random_pose(rng);
  return test::touch(part, world_T_part, strokes, kSigma, kSigma, rng);
}

void expect_same(const SegmentMatch& a, const SegmentMatch& b, const Pose2& b_T_a) {
  ASSERT_EQ(a.status, b.status);
  ASSERT_FALSE(a.placements.empty());
  const PartPlacement& p = a.placements[0];
  const PartPlacement& q = b.placements[0];
  EXPECT_NEAR(p.chi2, q.chi2, 1e-4);
  EXPECT_NEAR(p.probability, q.probability, 1e-3);
  EXPECT_NEAR(p.slide_sd_m, q.slide_sd_m, 1e-4 * p.slide_sd_m);
  const Pose2 moved = b_T_a * p.world_T_part;
  // In standard deviations.
  const Eigen::Vector3d apart(moved.x - q.world_T_part.x, moved.y - q.world_T_part.y,
                              wrap_angle(moved.theta - q.world_T_part.theta));
  EXPECT_LT(std::sqrt(apart.dot(q.covariance.inverse() * apart)), 1e-2);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.col(0).head<2>() = b_T_a.rotate(Vec2(1.0, 0.0));
  turn.col(1).head<2>() = b_T_a.rotate(Vec2(0.0, 1.0));
  EXPECT_LT((turn * p.covariance * turn.transpose() - q.covariance).norm(),
            1e-3 * q.covariance.norm());
}

TEST(SegmentMatchLaws, MovesWithTheSamples) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(10); ++i) {
    test::TouchedPart touched = touch_anywhere(part, {0.03}, rng);
    const SegmentMatch before = match_segment(part, touched.patches);
    const Pose2 motion = test::random_pose(rng);
    for (StoredSample& sample : touched.patches[0].samples) {
      sample.position_m = motion * sample.position_m;
    }
    expect_same(before, match_segment(part, touched.patches), motion);
  }
}

TEST(SegmentMatchLaws, ReversedSamplesLieWhereTheyLay) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(10); ++i) {
    test::TouchedPart touched = touch_anywhere(part, {0.03}, rng);
    const SegmentMatch before = match_segment(part, touched.patches);
    std::vector<StoredSample>& samples = touched.patches[0].samples;
    std::reverse(samples.begin(), samples.end());
    const SegmentMatch after = match_segment(part, touched.patches);
    expect_same(before, after, {});
    const PatchOnPart& p = before.placements[0].patches[0];
    const PatchOnPart& q = after.placements[0].patches[0];
    EXPECT_NE(p.along_increasing_t, q.along_increasing_t);
    for (std::size_t k = 0; k < p.samples.size(); ++k) {
      EXPECT_EQ(p.samples[k].segment, q.samples[p.samples.size() - 1 - k].segment);
    }
  }
}

TEST(SegmentMatchLaws, PatchesComeInAnyOrder) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(5); ++i) {
    test::TouchedPart touched = touch_anywhere(part, {0.03, 0.01}, rng);
    const SegmentMatch before = match_segment(part, touched.patches);
    std::swap(touched.patches[0], touched.patches[1]);
    const SegmentMatch after = match_segment(part, touched.patches);
    expect_same(before, after, {});
    EXPECT_EQ(before.longest_patch, 1 - after.longest_patch);
    EXPECT_EQ(before.placements[0].patches[0].segment, after.placements[0].patches[1].segment);
  }
}

TEST(SegmentMatchLaws, UnitsDoNotMatter) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const test::PartStroke stroke = random_stroke(part, 0.03, rng);
  for (const double unit : {1e-6, 1e6}) {
    auto same = test::test_rng(1);
    auto noise = test::test_rng(1);
    const test::TouchedPart metres = test::touch(part, {}, {stroke}, kSigma, kSigma, same);
    const test::TouchedPart other =
        test::touch(part.scaled(unit), {}, {{stroke.t0, unit * stroke.arc_m}}, unit * kSigma,
                    unit * kSigma, noise);
    const SegmentMatch a = match_segment(part, metres.patches);
    const SegmentMatch b = match_segment(part.scaled(unit), other.patches);
    ASSERT_EQ(a.status, b.status);
    EXPECT_NEAR(a.placements[0].chi2, b.placements[0].chi2, 1e-6);
    EXPECT_NEAR(a.placements[0].slide_sd_m, b.placements[0].slide_sd_m / unit,
                1e-6 * a.placements[0].slide_sd_m);
  }
}

struct Trials {
  int count = 0;
  int determined = 0;
  int determined_wrong = 0;       ///< another placement than the true one
  double expected_wrong = 0.0;    ///< sum of 1 - posterior over the determined ones
  int segment_wrong = 0;          ///< the most probable segment is a wrong one
  double segment_expected = 0.0;  ///< by the stated probabilities
  double segment_variance = 0.0;
  int no_match = 0;
  double squares = 0.0;  ///< normalised squared errors of the determined and right ones
  int in_95 = 0;
};

/// Strokes of one length, anywhere on the part.
Trials run_trials(double sigma_m, double arc_m, int count, int patches, std::mt19937_64& rng,
                  double correlation = 0.0) {
  const ClosedSpline part = test::paper_part();
  const double limit_95 = chi_square_threshold(0.05, 3);
  Trials trials;
  trials.count = count;
  for (int i = 0; i < count; ++i) {
    const Pose2 truth = test::random_pose(rng);
    std::vector<test::PartStroke> strokes;
    for (int p = 0; p < patches; ++p) {
      strokes.push_back(random_stroke(part, arc_m, rng));
    }
    const test::TouchedPart touched =
        test::touch(part, truth, strokes, sigma_m, sigma_m, rng, 0.0, correlation);
    const SegmentMatch match = match_segment(part, touched.patches);
    trials.no_match += match.status == SegmentMatchStatus::NoMatch;
    const std::vector<double>& t = touched.t[match.longest_patch];
    const std::size_t segment = part.segment_at(t[t.size() / 2]);
    const auto best =
        std::max_element(match.segment_probability.begin(), match.segment_probability.end());
    trials.segment_wrong +=
        static_cast<std::size_t>(best - match.segment_probability.begin()) != segment;
    trials.segment_expected += 1.0 - *best;
    trials.segment_variance += *best * (1.0 - *best);
    if (match.status != SegmentMatchStatus::Determined) {
      continue;
    }
    ++trials.determined;
    const PartPlacement& placement = match.placements[0];
    const Eigen::Vector3d error(placement.world_T_part.x - truth.x,
                                placement.world_T_part.y - truth.y,
                                wrap_angle(placement.world_T_part.theta - truth.theta));
    const double square = error.dot(placement.covariance.inverse() * error);
    // Another placement is hundreds of standard deviations away.
    constexpr double kAnother = 100.0;
    trials.expected_wrong += 1.0 - placement.probability;
    if (square > kAnother) {
      ++trials.determined_wrong;
    } else {
      trials.squares += square;
      trials.in_95 += square <= limit_95;
    }
  }
  return trials;
}

/// Posteriors and covariances must be true, to four standard deviations of each count. Prints the
/// results.
void expect_calibrated(const char* name, double sigma_m, double arc_m, int patches) {
  auto rng = test::test_rng();
  const Trials t = run_trials(sigma_m, arc_m, test::stress_count(150), patches, rng);
  const int right = t.determined - t.determined_wrong;
  std::printf(
      "%s: sigma %g mm, %d patch(es) of %g mm: %d trials, determined %d, of these wrong %d (stated "
      "%.2f); segment wrong %d (stated %.2f); no match %d; mean squared error %.2f (law 3), in 95 "
      "%% "
      "%.3f\n",
      name, 1e3 * sigma_m, patches, 1e3 * arc_m, t.count, t.determined, t.determined_wrong,
      t.expected_wrong, t.segment_wrong, t.segment_expected, t.no_match,
      right > 0 ? t.squares / right : 0.0, right > 0 ? static_cast<double>(t.in_95) / right : 0.0);
  if (!test::counts_tell()) {
    return;
  }
  // Rare events against their expectation: Poisson, plus one where almost none is expected.
  EXPECT_LE(t.determined_wrong, t.expected_wrong + 4.0 * std::sqrt(t.expected_wrong) + 1.0);
  EXPECT_NEAR(t.segment_wrong, t.segment_expected, 4.0 * std::sqrt(t.segment_variance) + 1.0);
  EXPECT_LE(t.no_match, 2);  // a thousandth of the trials is expected
  if (right >= 30) {
    EXPECT_NEAR(t.squares / right, 3.0, 4.0 * std::sqrt(6.0 / right));
    EXPECT_NEAR(static_cast<double>(t.in_95) / right, 0.95, 4.0 * std::sqrt(0.95 * 0.05 / right));
  }
}

TEST(SegmentMatchStatistics, SharpData) { expect_calibrated("sharp", 5e-6, 0.028, 1); }
TEST(SegmentMatchStatistics, NoisyData) { expect_calibrated("noisy", 5e-5, 0.028, 1); }
TEST(SegmentMatchStatistics, ShortPatches) { expect_calibrated("short", 2e-5, 0.015, 1); }
TEST(SegmentMatchStatistics, TwoPatches) { expect_calibrated("two patches", 5e-5, 0.02, 2); }
TEST(SegmentMatchStatistics, MuchNoise) { expect_calibrated("much noise", 2e-4, 0.028, 1); }

TEST(SegmentMatchStatistics, NoiseThatNeighboursShare) {
  auto rng = test::test_rng();
  for (const double correlation : {0.5, 0.8}) {
    const Trials t = run_trials(2e-5, 0.028, test::stress_count(150), 2, rng, correlation);
    const int right = t.determined - t.determined_wrong;
    const double square = t.squares / std::max(right, 1);
    std::printf(
        "correlation %g: %d trials, determined %d, wrong %d, no match %d; mean squared "
        "error %.2f (law 3)\n",
        correlation, t.count, t.determined, t.determined_wrong, t.no_match, square);
    if (test::counts_tell()) {
      // A part that is the right one is no match for one in a thousand; twice that, for it is only
      // estimated how many neighbours err together, from some 25 independent ones: to a third or
      // so.
      EXPECT_LE(t.no_match, test::most_of_poisson(2e-3 * t.count));
      EXPECT_LE(square, 3.0 * 4.0 / 3.0 + 4.0 * std::sqrt(6.0 / std::max(right, 1)));
      EXPECT_LE(t.determined_wrong, t.expected_wrong + 4.0 * std::sqrt(t.expected_wrong) + 1.0);
    }
  }
}

TEST(LongestSegmentStatistics, FalseJointsAreNoMoreThanTheSignificance) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const int count = test::stress_count(200);
  for (const double sigma_m : {1e-6, 2e-5}) {
    int found = 0;
    for (int i = 0; i < count; ++i) {
      const int segment = i % 5;
      const double length = part.arc_length(segment, segment + 1.0);
      const test::TouchedPart touched = test::touch(
          part, test::random_pose(rng), {{segment + 0.03, 0.9 * length}}, sigma_m, sigma_m, rng);
      found += !longest_segment(touched.patches[0]).joints.empty();
    }
    std::printf("sigma %g mm: joints in %d of %d patches of one segment\n", 1e3 * sigma_m, found,
                count);
    if (!test::counts_tell()) {
      continue;
    }
    EXPECT_LE(found, 0.01 * count + 4.0 * std::sqrt(0.01 * count));
  }
}

TEST(LongestSegmentStatistics, JointsAreFoundAndLieInTheirIntervals) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const int count = test::stress_count(100);
  for (const double sigma_m : {1e-6, 5e-6, 1e-5}) {
    int found = 0;
    int inside = 0;
    for (int i = 0; i < count; ++i) {
      const test::TouchedPart touched = test::touch(
          part, test::random_pose(rng), {{i % 5 + 0.4, 0.032, 161}}, sigma_m, sigma_m, rng);
      const auto& t = touched.t[0];
      const auto truth =
          static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), i % 5 + 1.0) - t.begin());
      const SegmentBelonging belonging = longest_segment(touched.patches[0]);
      if (!belonging.joints.empty()) {
        ++found;
        inside += std::any_of(belonging.joints.begin(), belonging.joints.end(),
                              [&](const SegmentJoint& joint) {
                                return joint.earliest <= truth && truth <= joint.latest;
                              });
      }
    }
    std::printf("sigma %g mm: joint found in %d of %d patches, true one in the interval %d\n",
                1e3 * sigma_m, found, count, inside);
    if (!test::counts_tell()) {
      continue;
    }
    if (sigma_m == 1e-6) {
      EXPECT_EQ(found, count);
    }
    EXPECT_GE(inside, 0.95 * found - 4.0 * std::sqrt(0.95 * 0.05 * found));
  }
}

TEST(LongestSegmentStatistics, SeveralJointsAreCounted) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (const double arc_m : {0.07, 0.1, 0.15}) {
    int right = 0;
    const int count = test::stress_count(20);
    for (int i = 0; i < count; ++i) {
      const test::TouchedPart touched =
          test::touch(part, test::random_pose(rng), {{i % 5 + 0.4, arc_m, 161}}, 1e-6, 1e-6, rng);
      const auto joints = static_cast<std::size_t>(std::floor(touched.t[0].back()) - i % 5);
      right += longest_segment(touched.patches[0]).joints.size() == joints;
    }
    std::printf("%g mm, sigma 0.001 mm: all joints and no more in %d of %d patches\n", 1e3 * arc_m,
                right, count);
    if (!test::counts_tell()) {
      continue;
    }
    EXPECT_GE(right, 0.9 * count);  // each run is tested at 1 %
  }
}

}  // namespace
}  // namespace palpate
