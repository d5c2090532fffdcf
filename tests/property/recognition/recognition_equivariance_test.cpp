// The answer moves, scales and forgets order as it must.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/curves/curve.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Two patches long enough that every class is told.
test::Scene told_scene(CurveClass curve_class, std::mt19937_64& rng) {
  test::SceneOptions options;
  options.patches = 2;
  options.least_fraction = 0.2;
  options.most_fraction = 0.45;
  options.sigma_over_size = 2e-4;
  return test::random_scene(curve_class, options, rng);
}

/// Rivals that are not nested in one another are sought on a grid that turns with the frame, and a sample
/// at the edge of the spike test may fall on either side: probabilities agree to a few hundredths, and a
/// decision is compared unless it hangs on those.
constexpr double kProbability = 0.03;

void expect_same(const Recognition& answer, const Recognition& other) {
  const double threshold = RecognizerOptions{}.recognized_probability;
  const double probability = answer.hypotheses.front().probability;
  ASSERT_EQ(other.shape.curve_class, answer.shape.curve_class);
  EXPECT_NEAR(other.hypotheses.front().probability, probability, kProbability);
  if (std::abs(probability - threshold) > kProbability) {
    EXPECT_EQ(other.status, answer.status);
  }
  const double allowed = other.outlier_count == answer.outlier_count ? 0.05 : 1.0;  // sd
  for (Eigen::Index k = 0; k < answer.covariance.rows() - 3; ++k) {
    EXPECT_NEAR(other.shape.values[k], answer.shape.values[k],
                allowed * std::sqrt(answer.covariance(k, k)));
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
      ASSERT_EQ(scaled.shape.curve_class, answer.shape.curve_class);
      EXPECT_NEAR(scaled.hypotheses.front().probability, answer.hypotheses.front().probability,
                  kProbability);
      EXPECT_NEAR(scaled.world_T_curve.x / factor, answer.world_T_curve.x,
                  0.05 * std::sqrt(answer.covariance(answer.covariance.rows() - 3,
                                                     answer.covariance.rows() - 3)) + 1e-9);
    }
    const Pose2 motion{3.0, -2.0, 2.2};
    test::Scene moved = scene;
    for (auto& patch : moved.patches) {
      for (Vec2& p : patch) {
        p = motion * p;
      }
    }
    const Recognition turned = test::recognise(moved, scene.sigma_m);
    expect_same(answer, turned);
  }
}

TEST_P(Equivariance, OrderAndDirectionOfPatchesDoNotMatter) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 5; ++i) {
    test::Scene scene = told_scene(GetParam(), rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    std::swap(scene.patches[0], scene.patches[1]);
    std::reverse(scene.patches[0].begin(), scene.patches[0].end());
    const Recognition other = test::recognise(scene, scene.sigma_m);
    expect_same(answer, other);
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
  EXPECT_GE(answer.contacts.size(), 8U);
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
