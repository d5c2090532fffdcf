// An answer that follows the one before, a few samples later, tells what a new search tells.
#include <gtest/gtest.h>

#include <cstdint>

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

}  // namespace
}  // namespace palpate
