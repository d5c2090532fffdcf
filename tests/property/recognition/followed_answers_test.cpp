// An answer that follows the one before, a few samples later, tells what a new search tells.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

Recognition followed(const test::Scene& scene, double sigma_m) {
  Recognizer recognizer;
  test::add_scene_followed(scene, sigma_m, &recognizer);
  return recognizer.recognize();
}

double of_truth(const Recognition& answer, const test::Scene& scene) {
  const Hypothesis* found = test::hypothesis_of(answer, scene.curve_class);
  return found != nullptr ? found->probability : 0.0;
}

/// What a search sees of the truth is not lost: a probability of more than a hundredth stays above
/// a thousandth.
void expect_not_lost(std::uint64_t seed, std::uint32_t number, bool stated) {
  const test::Scene scene = test::scene_from(test::even_prior(), seed, number).scene;
  const double sigma_m = stated ? scene.sigma_m : 0.0;
  if (of_truth(test::recognise(scene, sigma_m), scene) > 1e-2) {
    EXPECT_GT(of_truth(followed(scene, sigma_m), scene), 1e-3)
        << "seed " << seed << ", scene " << number << ", noise " << (stated ? "stated" : "unknown");
  }
}

TEST(FollowedAnswers, DoNotLoseTheTruth) {
  for (int i = 0; i < test::stress_count(400); ++i) {
    expect_not_lost(2026, static_cast<std::uint32_t>(i), true);
  }
}

/// Modes that only the prior leads to, and fits whose feet have parameters far from 0.
TEST(FollowedAnswers, KeepWhatIsHardToFind) {
  for (const std::uint32_t number : {459U, 1183U, 1254U, 2572U, 2789U, 2844U, 2884U}) {
    expect_not_lost(2026, number, true);
  }
  for (const std::uint32_t number : {1515U, 1770U, 2094U}) {
    expect_not_lost(8, number, false);
  }
}

/// Two flanks of a parabola leave a spline's shape open along a flat valley.
TEST(FollowedAnswers, OfAParabolaHaveTheSplineThatASearchHas) {
  constexpr double kA_m = 0.005;
  constexpr double kSigma_m = 5e-5;
  constexpr int kCount = 120;   // samples of a stroke
  constexpr int kAnswered = 8;  // at a time
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, kSigma_m);
  for (int scene = 0; scene < test::stress_count(40); ++scene) {
    Recognizer at_once;
    Recognizer followed;
    for (const std::uint32_t patch : {0U, 1U}) {
      const double side = patch == 0 ? 1.0 : -1.0;
      for (int i = 0; i < kCount; ++i) {
        const double t = side * (1.5 + static_cast<double>(i) / (kCount - 1));
        const Vec2 noise(normal(rng), normal(rng));
        const ContactSample sample{Vec2(kA_m * t * t, 2.0 * kA_m * t) + noise, kSigma_m, 0};
        at_once.add({.patch = patch}, {&sample, 1});
        followed.add({.patch = patch}, {&sample, 1});
        if (i % kAnswered == 0) followed.recognize();
      }
    }
    const auto of_spline = [](const Recognition& answer) {
      const Hypothesis* found = test::hypothesis_of(answer, CurveClass::CubicSpline);
      return found != nullptr ? found->probability : 0.0;
    };
    const double searched = of_spline(at_once.recognize());
    const double kept = of_spline(followed.recognize());
    // What either may miss of the other's (DoNotLoseTheTruth).
    EXPECT_TRUE(kept < 1e-2 || searched > 1e-3) << "searched " << searched << ", kept " << kept;
    EXPECT_TRUE(searched < 1e-2 || kept > 1e-3) << "searched " << searched << ", kept " << kept;
  }
}

/// A memory that is full forgets a patch for each that begins: their number stays, and nothing of
/// the answer need. Followed on, a class that was lost once stayed lost, and what was left was
/// certain.
TEST(FollowedAnswers, TellOnlyOfPatchesThatAreInMemory) {
  constexpr std::uint32_t kKept = 2;
  constexpr std::uint32_t kPatches = 6;
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(30); ++i) {
    test::SceneOptions options;
    options.patches = kPatches;
    options.points_per_patch = 40;
    options.sigma_over_size = 1e-3;
    options.least_fraction = 0.1;
    options.most_fraction = 0.4;
    const CurveClass curve_class =
        kCurveClasses[static_cast<std::size_t>(i) % kCurveClasses.size()];
    const test::Scene scene = test::random_scene(curve_class, options, rng);
    const double sigma_m = i % 2 == 0 ? scene.sigma_m : 0.0;
    RecognizerOptions few;
    few.memory.most_patches = kKept;
    Recognizer followed(few);
    const auto add = [&](std::uint32_t p, Recognizer* recognizer) {
      for (const Vec2& place_m : scene.patches[p]) {
        const ContactSample sample{place_m, sigma_m, 0};
        recognizer->add({.patch = p}, {&sample, 1});
      }
    };
    for (std::uint32_t p = 0; p < kPatches; ++p) {
      add(p, &followed);
      const Recognition answer = followed.recognize();
      if (p < kKept) continue;
      Recognizer anew(few);
      for (std::uint32_t q = p + 1 - kKept; q <= p; ++q) add(q, &anew);
      const Recognition searched = anew.recognize();
      for (const Hypothesis& hypothesis : searched.hypotheses) {
        const Hypothesis* found = test::hypothesis_of(answer, hypothesis.shape.curve_class);
        EXPECT_NEAR(found != nullptr ? found->probability : 0.0, hypothesis.probability, 1e-6)
            << i << ", patch " << p << ": " << name_of(hypothesis.shape.curve_class);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
