// Exact contacts on every segment of a known part come back as what they are.
#include "core/part/segment_match.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>

#include "tests/support/closed_spline_part.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kClaimedSigma = 1e-6;  // claimed; the samples themselves are exact

/// Distance of two curve parameters around the part.
double apart(const ClosedSpline& part, double t, const SamplePlace& place) {
  return std::abs(std::remainder(t - static_cast<double>(place.segment) - place.u,
                                 static_cast<double>(part.size())));
}

void expect_pose(const Pose2& got, const Pose2& truth, double tolerance) {
  EXPECT_NEAR(got.x, truth.x, tolerance);
  EXPECT_NEAR(got.y, truth.y, tolerance);
  EXPECT_NEAR(wrap_angle(got.theta - truth.theta), 0.0, tolerance);
}

TEST(SegmentMatch, EverySegmentInBothDirections) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int segment = 0; segment < 5; ++segment) {
    for (const bool along : {true, false}) {
      const double length = part.arc_length(segment, segment + 1.0);
      const test::PartStroke stroke{along ? segment + 0.02 : segment + 0.98,
                                    (along ? 0.9 : -0.9) * length};
      const Pose2 world_T_part = test::random_pose(rng);
      const test::TouchedPart touched =
          test::touch(part, world_T_part, {stroke}, 0.0, kClaimedSigma, rng);
      const SegmentMatch match = match_segment(part, touched.patches);
      ASSERT_EQ(match.status, SegmentMatchStatus::Determined) << segment << along;
      const PartPlacement& best = match.placements.front();
      EXPECT_GT(best.probability, 1.0 - 1e-9);
      EXPECT_LT(best.chi2, 1e-9);
      expect_pose(best.world_T_part, world_T_part, 1e-9);
      const PatchOnPart& place = best.patches[0];
      EXPECT_EQ(place.segment, static_cast<std::size_t>(segment));
      EXPECT_EQ(place.along_increasing_t, along);
      EXPECT_TRUE(place.beyond.empty());
      EXPECT_NEAR(match.segment_probability[place.segment], 1.0, 1e-9);
      for (std::size_t i = 0; i < touched.t[0].size(); ++i) {
        EXPECT_LT(apart(part, touched.t[0][i], place.samples[i]), 1e-9);
      }
    }
  }
}

TEST(SegmentMatch, SamplesBeyondAJointAreNamed) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  for (int joint = 0; joint < 5; ++joint) {
    const Pose2 world_T_part = test::random_pose(rng);
    const test::TouchedPart touched =
        test::touch(part, world_T_part, {{joint + 0.4, 0.03}}, 0.0, kClaimedSigma, rng);
    const SegmentMatch match = match_segment(part, touched.patches);
    ASSERT_EQ(match.status, SegmentMatchStatus::Determined) << joint;
    const PartPlacement& best = match.placements.front();
    EXPECT_LT(best.chi2, 1e-9);  // in full, on both segments
    std::vector<std::size_t> beyond;
    for (std::size_t i = 0; i < touched.t[0].size(); ++i) {
      const double t = touched.t[0][i];
      EXPECT_LT(apart(part, t, best.patches[0].samples[i]), 1e-9);
      EXPECT_EQ(best.patches[0].samples[i].segment, part.segment_at(t));
      if (part.segment_at(t) != best.patches[0].segment) {
        beyond.push_back(i);
      }
    }
    ASSERT_FALSE(beyond.empty());
    EXPECT_LT(beyond.size(), touched.t[0].size() / 2 + 1);
    EXPECT_EQ(best.patches[0].beyond, beyond);
  }
}

TEST(SegmentMatch, RoundTipsLieOutside) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const Pose2 world_T_part = test::random_pose(rng);
  const test::TouchedPart touched =
      test::touch(part, world_T_part, {{1.1, 0.025}, {3.8, -0.03}}, 0.0, kClaimedSigma, rng, 0.004);
  const SegmentMatch match = match_segment(part, touched.patches);
  ASSERT_EQ(match.status, SegmentMatchStatus::Determined);
  const PartPlacement& best = match.placements.front();
  expect_pose(best.world_T_part, world_T_part, 1e-9);
  for (std::size_t p = 0; p < 2; ++p) {
    for (std::size_t i = 0; i < touched.t[p].size(); ++i) {
      EXPECT_LT(apart(part, touched.t[p][i], best.patches[p].samples[i]), 1e-9);
    }
  }
}

TEST(SegmentMatch, MaterialSideRulesOutTheContraryTravel) {
  const ClosedSpline part = test::paper_part();  // counterclockwise: material left of increasing t
  auto rng = test::test_rng();
  test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{1.1, 0.025}}, 0.0, kClaimedSigma, rng);
  touched.patches[0].context.material_side = MaterialSide::Left;
  EXPECT_EQ(match_segment(part, touched.patches).status, SegmentMatchStatus::Determined);
  touched.patches[0].context.material_side = MaterialSide::Right;
  EXPECT_EQ(match_segment(part, touched.patches).status, SegmentMatchStatus::NoMatch);
}

TEST(SegmentMatch, CovarianceIsTheInverseOfTheInformationByDifferences) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const Pose2 truth{0.7, -0.4, 2.1};
  const test::TouchedPart touched = test::touch(part, truth, {{1.3, 0.04}}, 0.0, 1e-4, rng);
  const SegmentMatch match = match_segment(part, touched.patches);
  ASSERT_FALSE(match.placements.empty());
  // Distances of the exact points to the part at a pose moved by a step, over the step.
  const double step = 1e-7;
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(touched.t[0].size()), 3);
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    const Vec2& point = touched.patches[0].samples[static_cast<std::size_t>(i)].position_m;
    for (int k = 0; k < 3; ++k) {
      const auto distance = [&](double by) {
        Pose2 pose = truth;
        (k == 0 ? pose.x : k == 1 ? pose.y : pose.theta) += by;
        return part.foot_point(pose.to_local(point)).distance;
      };
      jacobian(i, k) = (distance(step) - distance(-step)) / (2.0 * step) / 1e-4;
    }
  }
  const Eigen::Matrix3d expected = (jacobian.transpose() * jacobian).inverse();
  const Eigen::Matrix3d& got = match.placements.front().covariance;
  EXPECT_LT((got - expected).norm(), 1e-5 * expected.norm());
}

TEST(SegmentMatch, NoiseIsEstimatedWhereSamplesBringNone) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  const test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{2.1, 0.028}}, 2e-5, 0.0, rng);
  const SegmentMatch match = match_segment(part, touched.patches);
  EXPECT_EQ(match.status, SegmentMatchStatus::Determined);
  // Relative standard deviation of about 1 / sqrt(2 * 100); four of them.
  EXPECT_NEAR(match.sigma_m / 2e-5, 1.0, 4.0 / std::sqrt(200.0));
  EXPECT_EQ(match.placements.front().patches[0].segment, 2U);
}

TEST(SegmentMatch, ASpikeIsSetAsideAndStillPlaced) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  test::TouchedPart touched =
      test::touch(part, test::random_pose(rng), {{2.1, 0.028}}, 1e-6, 1e-6, rng);
  touched.patches[0].samples[40].position_m += Vec2(3e-3, -1e-3);
  const SegmentMatch match = match_segment(part, touched.patches);
  ASSERT_EQ(match.status, SegmentMatchStatus::Determined);
  const PartPlacement& best = match.placements.front();
  EXPECT_EQ(best.dof, 111 - 1 - 3);
  EXPECT_TRUE(best.patches[0].samples[40].is_outlier);
  EXPECT_GT(std::abs(best.patches[0].samples[40].residual), 100.0);
  EXPECT_FALSE(best.patches[0].samples[41].is_outlier);
}

TEST(SegmentMatch, NothingSaysNothing) {
  const ClosedSpline part = test::paper_part();
  EXPECT_EQ(match_segment(part, {}).status, SegmentMatchStatus::TooFewSamples);
  std::vector<StoredPatch> patches(2);
  EXPECT_EQ(match_segment(part, patches).status, SegmentMatchStatus::TooFewSamples);
  patches[1].samples = {{{0.0, 0.0}, 1e-5, 1.0}, {{0.001, 0.0}, 1e-5, 1.0}};
  EXPECT_EQ(match_segment(part, patches).status, SegmentMatchStatus::TooFewSamples);
}

}  // namespace
}  // namespace palpate
