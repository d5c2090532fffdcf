// Strokes of unequal noise that nobody states: two fingers, or one that was moved faster.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "tests/support/most_of_poisson.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct Tally {
  int right = 0;
  int wrong = 0;

  void count(const Recognition& answer, CurveClass truth) {
    if (answer.status == RecognitionStatus::Recognized) {
      (answer.shape.curve_class == truth ? right : wrong) += 1;
    }
  }
};

/// The touches of a scene, every other stroke with `ratio` times the noise of those between.
test::Scene with_unequal_noise(const test::PriorScene& drawn, double ratio, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  test::Scene scene = drawn.scene;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    const double sigma_m = scene.sigma_m * (p % 2 == 0 ? 1.0 / std::sqrt(ratio) : std::sqrt(ratio));
    for (std::size_t i = 0; i < scene.patches[p].size(); ++i) {
      const double dx = normal(rng);
      scene.patches[p][i] = drawn.exact_patches[p][i] + sigma_m * Vec2(dx, normal(rng));
    }
  }
  return scene;
}

TEST(UnequalNoise, OfStrokesIsToldByEach) {
  const int scenes = test::stress_count(300);
  Tally alike;
  for (const double ratio : {1.0, 5.0, 20.0}) {
    Tally tally;
    for (int i = 0; i < scenes; ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      std::mt19937_64 rng = test::test_rng(number);
      const test::Scene scene = with_unequal_noise(
          test::scene_from(test::classes_only(test::even_prior()), test::test_seed(), number),
          ratio, rng);
      tally.count(test::recognise(scene, 0.0), scene.curve_class);
    }
    std::cout << "  every other stroke with " << ratio << " times the noise: RECOGNIZED "
              << tally.right << " of " << scenes << ", wrong " << tally.wrong << "\n";
    if (ratio == 1.0) {
      alike = tally;
    }
    if (test::counts_tell()) {
      // RECOGNIZED leaves at most 1 in 20 to doubt.
      EXPECT_LE(tally.wrong, test::most_of_poisson(0.05 * (tally.right + tally.wrong)));
      // The geometric mean of the noise is the same. What is lost in one stroke is gained in the
      // next, but for parts that only both together tell: a tenth.
      EXPECT_GE(10 * tally.right, 9 * alike.right);
    }
  }
}

}  // namespace
}  // namespace palpate
