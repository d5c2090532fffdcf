// Parts that look alike from several places, patches that determine little, and parts that are not
// the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/part/segment_belonging.h"
#include "core/part/segment_match.h"
#include "tests/support/closed_spline_part.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_curve.h"

namespace palpate {
namespace {

TEST(SegmentMatchHardCases, ASymmetricPartIsAmbiguous) {
  auto rng = test::test_rng();
  for (const int points : {4, 5, 6}) {
    const ClosedSpline part = test::symmetric_part(points);
    const test::TouchedPart touched =
        test::touch(part, test::random_pose(rng), {{0.1, 0.05, 201}}, 1e-7, 1e-7, rng);
    const SegmentMatch match = match_segment(part, touched.patches);
    ASSERT_EQ(match.status, SegmentMatchStatus::Ambiguous) << points;
    EXPECT_EQ(match.doubt, SegmentMatchDoubt::SeveralPlacements);
    // One placement per rotation. Each segment also has a mirror axis, so the travel may be
    // reversed.
    ASSERT_GE(match.placements.size(), static_cast<std::size_t>(points));
    for (int i = 0; i < points; ++i) {
      EXPECT_NEAR(match.placements[static_cast<std::size_t>(i)].probability,
                  match.placements[0].probability, 0.05);
      EXPECT_NEAR(match.segment_probability[static_cast<std::size_t>(i)], 1.0 / points, 0.05);
    }
  }
}

TEST(SegmentMatchHardCases, AHalfTurnSymmetricPartHasTwoPlacements) {
  // Control points that a half turn maps onto each other, but no reflection.
  const ClosedSpline part(
      {{0.04, 0.0}, {0.02, 0.035}, {-0.02, 0.015}, {-0.04, 0.0}, {-0.02, -0.035}, {0.02, -0.015}});
  auto rng = test::test_rng();
  const test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{0.3, 0.04, 161}}, 1e-6, 1e-6, rng);
  const SegmentMatch match = match_segment(part, touched.patches);
  ASSERT_EQ(match.status, SegmentMatchStatus::Ambiguous);
  ASSERT_EQ(match.placements.size(), 2U);
  EXPECT_NEAR(match.placements[0].probability, 0.5, 1e-3);
  EXPECT_EQ((match.placements[0].patches[0].segment + 3) % 6,
            match.placements[1].patches[0].segment);
}

TEST(SegmentMatchHardCases, AShortPatchIsAmbiguousRatherThanWrong) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> place(0.0, 5.0);
  int determined = 0;
  for (int i = 0; i < test::stress_count(30); ++i) {
    const test::TouchedPart touched =
        test::touch(part, test::random_pose(rng), {{place(rng), 0.004, 21}}, 2e-5, 2e-5, rng);
    const SegmentMatch match = match_segment(part, touched.patches);
    EXPECT_NE(match.status, SegmentMatchStatus::NoMatch);
    determined += match.status == SegmentMatchStatus::Determined;
  }
  EXPECT_EQ(determined, 0);
}

/// The paper's part with each control point displaced by 3 mm.
ClosedSpline other_part() {
  return ClosedSpline(
      {{0.033, 0.000}, {0.012, 0.031}, {-0.035, 0.022}, {-0.028, -0.021}, {0.007, -0.030}});
}

TEST(SegmentMatchHardCases, AnotherPartIsNoMatch) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int segment = 0; segment < 5; ++segment) {
    const test::TouchedPart touched = test::touch(other_part(), test::random_pose(rng),
                                                  {{segment + 0.1, 0.045}}, 1e-5, 1e-5, rng);
    const SegmentMatch match = match_segment(part, touched.patches);
    EXPECT_EQ(match.status, SegmentMatchStatus::NoMatch) << segment;
    EXPECT_FALSE(match.placements.empty());  // they say how badly the part fits
  }
}

/// What the part leaves at its best placement of a stroke without noise, in units of the noise: the
/// noncentrality of the test.
double difference_of(const ClosedSpline& part, const Pose2& pose, const test::PartStroke& stroke,
                     double sigma_m, std::mt19937_64& rng) {
  const test::TouchedPart exact = test::touch(other_part(), pose, {stroke}, 0.0, sigma_m, rng);
  const SegmentMatch match = match_segment(part, exact.patches);
  return match.placements.empty() ? 0.0 : match.placements[0].chi2;
}

// A short stroke has hardly more shape than its place along the model can compensate. If it happens
// to fit elsewhere, no answer can know better; otherwise the answer must say that it does not fit.
TEST(SegmentMatchHardCases, AShortStrokeOfAnotherPartFitsOnlyWhereNoiseHidesTheDifference) {
  // The rest is tested with 4 to 6 degrees of freedom at 1e-3, a threshold of 23. The test misses a
  // difference of 100, whose chi-square has a mean of 106 and a standard deviation of 20, for 3
  // strokes in 100,000.
  constexpr double kTold = 100.0;
  constexpr double kSigma_m = 1e-5;
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  int told = 0;
  int hidden = 0;
  const int strokes = test::stress_count(20);
  for (const double length_m : {0.02, 0.03}) {
    for (int i = 0; i < strokes; ++i) {
      const test::PartStroke stroke{0.25 * i + 0.1, length_m};
      const Pose2 pose = test::random_pose(rng);
      const double difference = difference_of(part, pose, stroke, kSigma_m, rng);
      const test::TouchedPart touched =
          test::touch(other_part(), pose, {stroke}, kSigma_m, kSigma_m, rng);
      const SegmentMatch match = match_segment(part, touched.patches);
      if (difference > kTold) {
        ++told;
        EXPECT_EQ(match.status, SegmentMatchStatus::NoMatch)
            << "stroke at " << stroke.t0 << ", " << length_m << " m, difference " << difference;
      } else {
        ++hidden;
      }
    }
  }
  if (!test::counts_tell()) return;
  // There must be some of both kinds, or the test says nothing.
  EXPECT_GE(told, 20);
  EXPECT_GE(hidden, 3);
}

TEST(SegmentMatchHardCases, TheMirroredPartIsNoMatch) {
  const ClosedSpline part = test::paper_part();
  const ClosedSpline mirrored(
      {{-0.030, 0.000}, {-0.012, 0.034}, {0.032, 0.022}, {0.028, -0.024}, {-0.010, -0.030}});
  auto rng = test::test_rng();
  for (int segment = 0; segment < 5; ++segment) {
    const test::TouchedPart touched =
        test::touch(mirrored, test::random_pose(rng), {{segment + 0.1, 0.04}}, 1e-6, 1e-6, rng);
    EXPECT_EQ(match_segment(part, touched.patches).status, SegmentMatchStatus::NoMatch) << segment;
  }
}

/// Points of no part at all, whose stated noise is negligible: scattered, a corner, a wave; of a
/// thousandth to ten times the part's size.
StoredPatch nonsense(std::mt19937_64& rng, int kind) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double size_m = 0.05 * std::pow(10.0, 2.0 * uniform(rng));
  const double shape = uniform(rng);
  const int count = 15 + static_cast<int>(20.0 * (1.0 + uniform(rng)));
  StoredPatch patch;
  for (int i = 0; i < count; ++i) {
    const double t = 2.0 * i / (count - 1) - 1.0;
    const double height = kind == 0   ? uniform(rng)
                          : kind == 1 ? shape * std::abs(t - 0.3 * shape)
                                      : 0.2 * std::sin(6.0 * t + shape);
    const double along = kind == 0 ? uniform(rng) : t;
    patch.samples.push_back({Vec2(size_m * along, size_m * height), 1e-5 * size_m, 1.0});
  }
  return patch;
}

TEST(SegmentMatchHardCases, WhatFitsNowhereStillHasProbabilitiesThatAreNumbers) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(60); ++i) {
    const StoredPatch patch = nonsense(rng, i % 3);
    const SegmentMatch match = match_segment(part, std::span(&patch, 1));
    ASSERT_EQ(match.status, SegmentMatchStatus::NoMatch) << i;
    double placements = 0.0;
    for (const PartPlacement& placement : match.placements) placements += placement.probability;
    EXPECT_NEAR(placements, match.placements.empty() ? 0.0 : 1.0, 1e-9) << i;
    double segments = 0.0;
    for (const double probability : match.segment_probability) segments += probability;
    EXPECT_NEAR(segments, match.placements.empty() ? 0.0 : 1.0, 1e-9) << i;
  }
}

TEST(SegmentMatchHardCases, AJointLiesAmongTheSamplesThatItParts) {
  auto rng = test::test_rng();
  int joints = 0;
  for (int i = 0; i < test::stress_count(60); ++i) {
    const StoredPatch patch = nonsense(rng, i % 3);
    for (const SegmentJoint& joint : longest_segment(patch).joints) {
      ++joints;
      double nearest = std::numeric_limits<double>::infinity();
      double longest_step = 0.0;
      for (std::size_t k = 0; k < patch.samples.size(); ++k) {
        const Vec2& here = patch.samples[k].position_m;
        nearest = std::min(nearest, (joint.position_m - here).norm());
        // Samples between them were set aside, so a step may skip some.
        for (std::size_t other = 0; other < k; ++other) {
          longest_step = std::max(longest_step, (here - patch.samples[other].position_m).norm());
        }
      }
      EXPECT_LE(nearest, 0.5 * longest_step) << i;
    }
  }
  if (test::counts_tell()) {  // two strokes need not have one
    EXPECT_GT(joints, 0);
  }
}

TEST(SegmentMatchHardCases, AnEllipseAndAStraightEdgeAreNoMatch) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const auto match_of = [&](const test::Scene& scene) {
    StoredPatch patch;
    for (const Vec2& position : scene.patches[0]) {
      patch.samples.push_back({position, scene.sigma_m, 1.0});
    }
    return match_segment(part, std::span(&patch, 1)).status;
  };
  const std::vector<test::Stroke> stroke = {{0.4, 0.04}};
  EXPECT_EQ(match_of(test::touched_curve(Ellipse{0.035, 0.02}, {0.1, 0.2, 0.3}, stroke, 1e-5, rng)),
            SegmentMatchStatus::NoMatch);
  EXPECT_EQ(match_of(test::touched_curve(Line{}, {0.1, 0.2, 0.3}, stroke, 1e-5, rng)),
            SegmentMatchStatus::NoMatch);
}

TEST(SegmentMatchHardCases, FarFromTheOrigin) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const Pose2 truth{1e6, -1e6, 0.7};
  const test::TouchedPart touched = test::touch(part, truth, {{1.1, 0.03}}, 1e-6, 1e-6, rng);
  const SegmentMatch match = match_segment(part, touched.patches);
  ASSERT_EQ(match.status, SegmentMatchStatus::Determined);
  EXPECT_EQ(match.placements[0].patches[0].segment, 1U);
  EXPECT_NEAR(match.placements[0].world_T_part.x, truth.x, 1e-4);
}

TEST(SegmentMatchHardCases, ACounterclockwiseModelAndAClockwiseOneAgree) {
  const ClosedSpline part = test::paper_part();
  const ClosedSpline clockwise(
      {{0.010, -0.030}, {-0.028, -0.024}, {-0.032, 0.022}, {0.012, 0.034}, {0.030, 0.000}});
  ASSERT_LT(clockwise.signed_area(), 0.0);
  auto rng = test::test_rng();
  const Pose2 truth = test::random_pose(rng);
  const test::TouchedPart touched = test::touch(part, truth, {{1.1, 0.03}}, 1e-6, 1e-6, rng, 0.003);
  const SegmentMatch match = match_segment(clockwise, touched.patches);
  ASSERT_EQ(match.status, SegmentMatchStatus::Determined);
  EXPECT_FALSE(match.placements[0].patches[0].along_increasing_t);
  EXPECT_NEAR(match.placements[0].world_T_part.x, truth.x, 1e-4);
}

TEST(SegmentMatchHardCases, RepeatedAndDwellingSamplesDoNoHarm) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{1.1, 0.03}}, 1e-6, 1e-6, rng);
  std::vector<StoredSample>& samples = touched.patches[0].samples;
  const StoredSample dwelt = samples[50];
  samples.insert(samples.begin() + 50, 40, dwelt);
  const SegmentMatch match = match_segment(part, touched.patches);
  ASSERT_FALSE(match.placements.empty());
  EXPECT_EQ(match.placements[0].patches[0].segment, 1U);
}

}  // namespace
}  // namespace palpate
