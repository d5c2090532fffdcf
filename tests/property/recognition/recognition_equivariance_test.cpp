// The answer must move and scale with the samples and must not depend on their order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/curves/curve.h"
#include "core/curves/length_powers.h"
#include "tests/support/canonical_points.h"
#include "tests/support/joint_error.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Two patches that are long enough to determine every class.
test::Scene told_scene(CurveClass curve_class, std::mt19937_64& rng) {
  test::SceneOptions options;
  options.patches = 2;
  options.least_fraction = 0.2;
  options.most_fraction = 0.45;
  options.sigma_over_size = 2e-4;
  return test::random_scene(curve_class, options, rng);
}

/// Rivals that are not nested in one another are searched for on a grid that turns with the frame,
/// and a sample at the edge of the spike test may fall on either side. So probabilities agree to a
/// few hundredths, and a decision is compared unless it depends on such a difference.
constexpr double kProbability = 0.03;

/// The answer as the truth that another answer is compared with: moved, then enlarged.
test::Scene as_truth(const Recognition& answer, const Pose2& motion, double factor) {
  test::Scene truth;
  truth.curve_class = answer.shape.curve_class;
  const Eigen::Vector3d powers = length_powers(truth.curve_class);
  for (Eigen::Index k = 0; k < 3; ++k) {
    truth.values[k] = answer.shape.values[k] * std::pow(factor, powers[k]);
  }
  truth.world_T_curve = motion * answer.world_T_curve;
  truth.world_T_curve.x *= factor;
  truth.world_T_curve.y *= factor;
  return truth;
}

/// `other` is the answer to the samples of `answer` moved, then enlarged by `factor`, or in another
/// order.
void expect_same(const Recognition& answer, const Recognition& other, const Pose2& motion = {},
                 double factor = 1.0) {
  const double threshold = RecognizerOptions{}.recognized_probability;
  const double probability = answer.hypotheses.front().probability;
  ASSERT_EQ(other.shape.curve_class, answer.shape.curve_class);
  EXPECT_NEAR(other.hypotheses.front().probability, probability, kProbability);
  // The tree's tests use windows that begin where the stroke does. In reverse order these are other
  // windows, and each test may reject the truth as often as its significance says.
  const bool tree_rejects = other.doubt == Doubt::TreeRejects || answer.doubt == Doubt::TreeRejects;
  if (std::abs(probability - threshold) > kProbability && !tree_rejects) {
    EXPECT_EQ(other.status, answer.status)
        << name_of(other.doubt) << " and " << name_of(answer.doubt);
  }
  if (answer.shape.curve_class == CurveClass::Unclassified) {
    return;
  }
  const bool same_samples = other.outlier_count == answer.outlier_count;
  const double allowed = same_samples ? 0.05 : 1.0;  // standard deviations
  const test::Scene truth = as_truth(answer, motion, factor);
  const test::JointError joint = test::joint_error(other.hypotheses.front(), truth);
  for (Eigen::Index k = 0; k < joint.error.size(); ++k) {
    EXPECT_LE(std::abs(joint.error[k]), allowed * std::sqrt(joint.covariance(k, k)))
        << "component " << k;
  }
  // Shape and pose together, with the covariance that both should have.
  EXPECT_LE(test::squared_distance(joint),
            allowed * allowed * static_cast<double>(joint.error.size()));
  test::Scene unmoved = truth;
  unmoved.world_T_curve = answer.world_T_curve;
  const test::JointError own = test::joint_error(answer.hypotheses.front(), unmoved);
  if (same_samples) {
    // Shape parameters only, because a motion mixes the variances of the pose.
    const auto letters =
        static_cast<Eigen::Index>(parameter_letters(answer.shape.curve_class).size());
    const Eigen::Vector3d powers = length_powers(answer.shape.curve_class);
    for (Eigen::Index k = 0; k < letters; ++k) {
      constexpr double kSameDeviation = 0.02;  // relative
      EXPECT_NEAR(
          std::sqrt(joint.covariance(k, k) / own.covariance(k, k)) / std::pow(factor, powers[k]),
          1.0, kSameDeviation)
          << "component " << k;
    }
  }
}

class Equivariance : public testing::TestWithParam<CurveClass> {};

TEST_P(Equivariance, ScaleAndMotionCarryTheAnswerAlong) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 5; ++i) {
    const test::Scene scene = told_scene(GetParam(), rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
      test::Scene large = scene;
      for (auto& patch : large.patches) {
        for (Vec2& p : patch) {
          p *= factor;
        }
      }
      const Recognition scaled = test::recognise(large, scene.sigma_m * factor);
      SCOPED_TRACE(testing::Message() << "scaled by " << factor);
      expect_same(answer, scaled, {}, factor);
    }
    const Pose2 motion{3.0, -2.0, 2.2};
    test::Scene moved = scene;
    for (auto& patch : moved.patches) {
      for (Vec2& p : patch) {
        p = motion * p;
      }
    }
    const Recognition turned = test::recognise(moved, scene.sigma_m);
    SCOPED_TRACE("moved");
    expect_same(answer, turned, motion);
  }
}

TEST_P(Equivariance, OrderAndDirectionOfPatchesDoNotMatter) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 5; ++i) {
    const test::Scene scene = told_scene(GetParam(), rng);
    test::Scene back = scene;
    std::swap(back.patches[0], back.patches[1]);
    std::reverse(back.patches[0].begin(), back.patches[0].end());
    for (const double stated_m : {scene.sigma_m, 0.0}) {
      SCOPED_TRACE(testing::Message() << "stated noise " << stated_m);
      expect_same(test::recognise(scene, stated_m), test::recognise(back, stated_m));
    }
  }
}

TEST_P(Equivariance, ContactsLieOnTheCurveWhereTheySay) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = told_scene(GetParam(), rng);
  const Recognition answer = test::recognise(scene, scene.sigma_m);
  if (answer.shape.curve_class == CurveClass::Unclassified) {
    return;
  }
  const auto curve = make_curve(answer.shape.curve_class, answer.shape.values);
  ASSERT_TRUE(curve.has_value());
  // At least two windows for each of two patches, except where a spline bends more sharply than the
  // samples can follow.
  const std::size_t fewest = GetParam() == CurveClass::CubicSpline ? 3 : 4;
  EXPECT_GE(answer.contacts.size(), fewest);
  for (const LocalizedContact& contact : answer.contacts) {
    const Vec2 placed = answer.world_T_curve * position(*curve, contact.t);
    EXPECT_LT((placed - contact.estimate.position).norm(), 10.0 * scene.sigma_m);
  }
  EXPECT_FALSE(answer.decisions.empty());
}

INSTANTIATE_TEST_SUITE_P(AllClasses, Equivariance, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
