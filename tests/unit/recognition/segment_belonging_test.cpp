// Where a patch leaves one cubic for another, without any model of the part.
#include "core/part/segment_belonging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/numerics/probability/chi_square.h"
#include "tests/support/closed_spline_part.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kStatedSigma = 1e-6;  // claimed; the samples themselves are exact

/// The first sample beyond the only joint of a stroke.
std::size_t joint_index(const std::vector<double>& t) {
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (std::floor(t[i]) != std::floor(t[i - 1])) {
      return i;
    }
  }
  return t.size();
}

TEST(LongestSegment, ExactSamplesOfOneSegmentAllBelong) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int segment = 0; segment < 5; ++segment) {
    const double length = part.arc_length(segment, segment + 1.0);
    const test::TouchedPart touched = test::touch(
        part, test::random_pose(rng), {{segment + 0.02, 0.9 * length}}, 0.0, kStatedSigma, rng);
    const SegmentBelonging found = longest_segment(touched.patches[0]);
    EXPECT_TRUE(found.joints.empty());
    EXPECT_TRUE(found.outside.empty());
    EXPECT_EQ(found.begin, 0U);
    EXPECT_EQ(found.end, 111U);
    EXPECT_EQ(found.dof, 105);
    EXPECT_LT(found.chi2, 1e-6);
  }
}

TEST(LongestSegment, TheSamplesBeyondAJointAreNamedExactly) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const int segments = test::stress_count(5);
  for (int segment = 0; segment < segments; ++segment) {
    for (const bool along : {true, false}) {
      const test::PartStroke stroke{along ? segment + 0.35 : segment + 1.65, along ? 0.035 : -0.035,
                                    161};
      const Pose2 world_T_part = test::random_pose(rng);
      const test::TouchedPart touched =
          test::touch(part, world_T_part, {stroke}, 0.0, kStatedSigma, rng);
      const std::size_t truth = joint_index(touched.t[0]);
      ASSERT_LT(truth, 161U);
      const SegmentBelonging found = longest_segment(touched.patches[0]);
      ASSERT_EQ(found.joints.size(), 1U) << segment << along;
      const SegmentJoint& joint = found.joints[0];
      EXPECT_EQ(joint.index, truth);
      EXPECT_LE(joint.earliest, truth);
      EXPECT_GE(joint.latest, truth);
      const double t_joint = std::round(0.5 * (touched.t[0][truth] + touched.t[0][truth - 1]));
      EXPECT_LT((joint.position_m - world_T_part * part.position(t_joint)).norm(), 1e-5);
      const bool first_is_longer = truth >= 161 - truth;
      EXPECT_EQ(found.begin, first_is_longer ? 0 : truth);
      EXPECT_EQ(found.end, first_is_longer ? truth : 161);
      EXPECT_EQ(found.outside.size(), 161 - (found.end - found.begin));
      for (const std::size_t i : found.outside) {
        EXPECT_TRUE(i < found.begin || i >= found.end);
      }
      EXPECT_LT(found.chi2, 1e-6);
    }
  }
}

TEST(LongestSegment, TwoJointsAreFoundOneAfterTheOther) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  // From the middle of the second segment to that of the fourth.
  const test::PartStroke stroke{1.5, part.arc_length(1.5, 3.5), 300};
  const test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {stroke}, kStatedSigma, kStatedSigma, rng);
  const SegmentBelonging found = longest_segment(touched.patches[0]);
  ASSERT_EQ(found.joints.size(), 2U);
  for (std::size_t j = 0; j < 2; ++j) {
    const auto truth = static_cast<std::size_t>(
        std::lower_bound(touched.t[0].begin(), touched.t[0].end(), static_cast<double>(j) + 2.0) -
        touched.t[0].begin());
    EXPECT_LE(found.joints[j].earliest, truth);
    EXPECT_GE(found.joints[j].latest, truth);
    EXPECT_LE(found.joints[j].latest - found.joints[j].earliest, 80U);
  }
  // The third segment, between them, is the longest run.
  EXPECT_EQ(found.begin, found.joints[0].index);
  EXPECT_EQ(found.end, found.joints[1].index);
  EXPECT_GT(chi_square_survival(found.chi2, found.dof), 1e-3);
}

TEST(LongestSegment, ALongPatchHasItsJointAmongAllItsSamples) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const test::TouchedPart touched = test::touch(
      part, test::random_pose(rng), {{1.35, 0.035, 20'011}}, kStatedSigma, kStatedSigma, rng);
  const std::size_t truth = joint_index(touched.t[0]);
  const SegmentBelonging found = longest_segment(touched.patches[0]);
  ASSERT_EQ(found.joints.size(), 1U);
  const SegmentJoint& joint = found.joints[0];
  EXPECT_LE(joint.earliest, truth);
  EXPECT_GE(joint.latest, truth);
  EXPECT_GE(joint.latest - joint.earliest, 20U);  // those between two that were tested
  EXPECT_LE(joint.latest - joint.earliest, 20'011U / 2);
  EXPECT_LE(joint.earliest, joint.index);
  EXPECT_LE(joint.index, joint.latest);
  const bool first_is_longer = joint.index >= 20'011 - joint.index;
  EXPECT_EQ(found.begin, first_is_longer ? 0 : joint.index);
  EXPECT_EQ(found.end, first_is_longer ? joint.index : 20'011);
  EXPECT_EQ(static_cast<std::size_t>(found.dof) + 6,  // the cubic's own test is of all samples
            first_is_longer ? joint.earliest : 20'011 - joint.latest);
  EXPECT_GT(chi_square_survival(found.chi2, found.dof), 1e-3);
}

TEST(LongestSegment, RoundTipsAndUnknownNoise) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const test::TouchedPart touched = test::touch(part, test::random_pose(rng), {{1.35, 0.035, 161}},
                                                kStatedSigma, 0.0, rng, 0.003);
  const std::size_t truth = joint_index(touched.t[0]);
  const SegmentBelonging found = longest_segment(touched.patches[0]);
  ASSERT_EQ(found.joints.size(), 1U);
  EXPECT_LE(found.joints[0].earliest, truth);
  EXPECT_GE(found.joints[0].latest, truth);
  EXPECT_NEAR(found.sigma_m / kStatedSigma, 1.0, 4.0 / std::sqrt(2.0 * 150.0));
}

TEST(LongestSegment, ASpikeDoesNotBelong) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{2.02, 0.025}}, kStatedSigma, kStatedSigma, rng);
  touched.patches[0].samples[30].position_m += Vec2(1e-3, 2e-3);
  const SegmentBelonging found = longest_segment(touched.patches[0]);
  EXPECT_TRUE(found.joints.empty());
  EXPECT_EQ(found.outside, (std::vector<std::size_t>{30}));
  EXPECT_EQ(found.end, 111U);
}

TEST(LongestSegment, FewSamplesAreNotTested) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  EXPECT_TRUE(longest_segment(StoredPatch{}).joints.empty());
  const test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{0.9, 0.02, 20}}, kStatedSigma, kStatedSigma, rng);
  const SegmentBelonging found = longest_segment(touched.patches[0]);
  EXPECT_TRUE(found.joints.empty());
  EXPECT_EQ(found.end, 20U);
}

}  // namespace
}  // namespace palpate
