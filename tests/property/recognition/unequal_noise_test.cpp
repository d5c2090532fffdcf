// Unequal noise: of strokes, where nobody states it (two fingers, or one that was moved faster),
// and across the path alone (a probe that is read at the steps of an exact axis).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/random_scene.h"
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

/// The touches of a scene with noise of five mean steps, across the path alone or in any direction.
test::Scene with_dense_noise(const test::PriorScene& drawn, bool across, std::mt19937_64& rng) {
  constexpr double kSteps = 5.0;
  double way = 0.0;
  double steps = 0.0;
  for (const auto& patch : drawn.exact_patches) {
    for (std::size_t i = 1; i < patch.size(); ++i) {
      way += (patch[i] - patch[i - 1]).norm();
      steps += 1.0;
    }
  }
  std::normal_distribution<double> normal;
  test::Scene scene = drawn.scene;
  scene.sigma_m = kSteps * way / steps;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    const std::vector<Vec2>& exact = drawn.exact_patches[p];
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Vec2 along = exact[std::min(i + 1, exact.size() - 1)] - exact[i > 0 ? i - 1 : 0];
      const double dx = normal(rng);
      const Vec2 any(dx, normal(rng));
      scene.patches[p][i] =
          exact[i] + scene.sigma_m * (across ? Vec2(dx * left_of(along.normalized())) : any);
    }
  }
  return scene;
}

TEST(UnequalNoise, AcrossThePathAloneIsNoTurning) {
  const int scenes = test::stress_count(300);
  Tally any;
  Tally across;
  for (int i = 0; i < scenes; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    const test::PriorScene drawn =
        test::scene_from(test::classes_only(test::even_prior()), test::test_seed(), number);
    for (Tally* tally : {&any, &across}) {
      std::mt19937_64 rng = test::test_rng(number);
      const test::Scene scene = with_dense_noise(drawn, tally == &across, rng);
      tally->count(test::recognise(scene, scene.sigma_m), scene.curve_class);
    }
  }
  std::cout << "  noise of five steps, across the path alone: RECOGNIZED " << across.right << " of "
            << scenes << ", wrong " << across.wrong << "; in any direction " << any.right << ", "
            << any.wrong << "\n";
  if (test::counts_tell()) {
    EXPECT_LE(across.wrong, test::most_of_poisson(0.05 * (across.right + across.wrong)));
    // A distance from a curve is across it: noise along the path changes little.
    EXPECT_GE(4 * across.right, 3 * any.right);
  }
}

/// One sample in ten says, truly, that it is 300 times as loud as the others: the mean of the
/// variances that a stroke states is as large as the stroke, which is not all one place for that.
TEST(UnequalNoise, OfAFewLoudSamplesLeavesTheOthersWhereTheyAre) {
  constexpr double kSigma = 1e-5;  // [m]
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.patches = 4;
  options.points_per_patch = 60;
  options.sigma_over_size = 1e-9;
  options.size_m = 0.025;
  const int scenes = test::stress_count(15);
  int all = 0;
  int first = 0;
  for (const CurveClass curve_class : kCurveClasses) {
    for (int i = 0; i < scenes; ++i) {
      const test::Scene exact = test::random_scene(curve_class, options, rng);
      Recognizer recognizer;
      PatchContext context;
      for (const std::vector<Vec2>& way : exact.patches) {
        std::vector<ContactSample> samples;
        for (const Vec2& place : way) {
          const double sigma_m = kSigma * (test::uniform(rng, 0.0, 1.0) < 0.1 ? 300.0 : 1.0);
          samples.push_back({place + test::normal_pair(rng, sigma_m), sigma_m, 0});
        }
        recognizer.add(context, samples);
        ++context.patch;
      }
      const Recognition answer = recognizer.recognize();
      const Hypothesis* truth = test::hypothesis_of(answer, curve_class);
      ++all;
      first += truth != nullptr && truth == answer.hypotheses.data() ? 1 : 0;
    }
  }
  std::cout << "  with loud samples: of " << all << " most probably what they are " << first
            << "\n";
  // What is asked of scenes whose class the data determine (bench_posterior), less four deviations
  // of so many scenes.
  const double missed = 0.08 * all;
  EXPECT_GE(first, all - missed - 4.0 * std::sqrt(missed));
}

}  // namespace
}  // namespace palpate
