// Stated probabilities must be true: of the answers stated with probability p, a fraction p must be
// right.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/support/calibration.h"
#include "tests/support/expect_calibrated.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr int kScenes = 4800;
constexpr double kCoverage = 0.999;

/// Calibration of the most probable hypothesis, over all answers and by the class that it names.
struct Calibrations {
  test::Calibration pooled;
  std::array<test::Calibration, 9> by_class;
};

Calibrations run(const test::ScenePrior& prior, bool sigma_known) {
  Calibrations result;
  const int scenes = test::stress_count(kScenes);
  for (int i = 0; i < scenes; ++i) {
    const test::PriorScene drawn =
        test::scene_from(prior, test::test_seed(), static_cast<std::uint32_t>(i));
    const Recognition answer =
        test::recognise(drawn.scene, sigma_known ? drawn.scene.sigma_m : 0.0);
    EXPECT_FALSE(answer.hypotheses.empty()) << "scene " << i;
    if (answer.hypotheses.empty()) {
      continue;
    }
    const double probability = answer.hypotheses.front().probability;
    EXPECT_TRUE(std::isfinite(probability)) << "scene " << i;
    const bool right = answer.shape.curve_class == drawn.scene.curve_class;
    result.pooled.add(probability, right);
    result.by_class[static_cast<std::size_t>(answer.shape.curve_class)].add(probability, right);
  }
  return result;
}

void expect_true(const Calibrations& calibrations) {
  // Below these bounds several classes fit, and their prior masses decide. There the scenes differ
  // from the prior: their places end where the parts do, while the prior has tails; and the
  // integral of a class that is wide in two directions is too small.
  constexpr double kPooledFrom = 0.6;
  constexpr double kClassesFrom = 0.95;
  test::expect_calibrated(calibrations.pooled, "all", kPooledFrom, kCoverage);
  // No scene is of no class here: what is stated about "unclassified" is true under another prior.
  for (std::size_t i = 1; i < calibrations.by_class.size(); ++i) {
    test::expect_calibrated(calibrations.by_class[i],
                            std::string(name_of(static_cast<CurveClass>(i))), kClassesFrom,
                            kCoverage);
  }
  // Otherwise the bins above would say nothing about sure answers.
  EXPECT_GT(calibrations.pooled.bins().back().count(), test::stress_count(kScenes) / 4);
}

TEST(PosteriorCalibration, WithTheNoiseStated) {
  expect_true(run(test::classes_only(test::even_prior()), true));
}

TEST(PosteriorCalibration, WithTheNoiseUnknown) {
  expect_true(run(test::classes_only(test::even_prior()), false));
}

}  // namespace
}  // namespace palpate
