// Points of a formula, without noise and none stated: what somebody tries first.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct ExactAnswers {
  int right = 0;
  int wrong = 0;
  int cut = 0;  ///< by the limit of work

  void count(const Recognition& answer, CurveClass truth) {
    if (answer.status == RecognitionStatus::Recognized) {
      (answer.shape.curve_class == truth ? right : wrong) += 1;
    }
    cut += answer.doubt == Doubt::WorkLimit ? 1 : 0;
  }
};

TEST(ExactPoints, AreRecognizedAtLeastAsOftenAsNoisyOnes) {
  test::ScenePrior prior = test::classes_only(test::even_prior());
  prior.least_sigma_over_size = prior.most_sigma_over_size = 1e-3;
  const int scenes = test::stress_count(200);
  ExactAnswers exact;
  ExactAnswers noisy;
  for (int i = 0; i < scenes; ++i) {
    const test::PriorScene drawn =
        test::scene_from(prior, test::test_seed(), static_cast<std::uint32_t>(i));
    noisy.count(test::recognise(drawn.scene, 0.0), drawn.scene.curve_class);
    test::Scene formula = drawn.scene;
    formula.patches = drawn.exact_patches;
    exact.count(test::recognise(formula, 0.0), formula.curve_class);
  }
  std::cout << "  exact points: RECOGNIZED " << exact.right << " of " << scenes << ", wrong "
            << exact.wrong << ", by the limit of work " << exact.cut
            << "; with noise of a thousandth " << noisy.right << ", " << noisy.wrong << ", "
            << noisy.cut << "\n";
  EXPECT_EQ(exact.wrong, 0);
  if (test::counts_tell()) {
    EXPECT_GE(exact.right, noisy.right);
  }
}

}  // namespace
}  // namespace palpate
