// Conics whose strokes lead round the tip of a needle, or go back a little on their way: the fit
// that a search finds must not be taken for one that no probe touches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using Stroke = std::vector<ContactSample>;

struct StrokedScene {
  CurveClass truth = CurveClass::Ellipse;
  std::vector<Stroke> strokes;
};

/// Draws even steps along a curve, with noise.
class Pen {
 public:
  Pen(std::function<Vec2(double)> at, double sigma_m) : at_(std::move(at)), sigma_m_(sigma_m) {}

  /// From one parameter towards another in so many steps.
  void go(double from, double to, int steps, std::mt19937_64& rng, Stroke* stroke) const {
    constexpr int kChords = 2000;  // some to each step: even to a hundredth
    std::vector<double> length(kChords + 1, 0.0);
    const auto parameter = [&](double k) { return from + (to - from) * k / kChords; };
    for (std::size_t k = 1; k <= kChords; ++k) {
      const auto d = static_cast<double>(k);
      length[k] = length[k - 1] + (at_(parameter(d)) - at_(parameter(d - 1.0))).norm();
    }
    std::normal_distribution<double> noise(0.0, sigma_m_);
    for (int i = 0; i < steps; ++i) {
      const double wanted = length.back() * i / steps;
      const auto next = std::upper_bound(length.begin(), length.end(), wanted);
      const auto k = static_cast<double>(next - length.begin() - 1);
      const double share = (wanted - *(next - 1)) / (*next - *(next - 1));
      const double x = noise(rng);
      stroke->push_back({at_(parameter(k + share)) + Vec2(x, noise(rng)), sigma_m_, 0});
    }
  }

 private:
  std::function<Vec2(double)> at_;
  double sigma_m_;
};

std::function<Vec2(double)> ellipse(double a, double b) {
  return [a, b](double t) { return Vec2(a * std::cos(t), b * std::sin(t)); };
}

std::function<Vec2(double)> hyperbola(double a, double b) {
  return [a, b](double t) { return Vec2(a * std::cosh(t), b * std::sinh(t)); };
}

constexpr double kHalfExtent_m = 0.03;

/// Three strokes round the tips of a needle.
StrokedScene needle_scene(std::mt19937_64& rng) {
  const double b = kHalfExtent_m * test::log_uniform(rng, 0.03, 0.1);
  const Pen pen(ellipse(kHalfExtent_m, b), b * test::log_uniform(rng, 3e-3, 0.03));
  StrokedScene scene;
  for (int k = 0; k < 3; ++k) {
    const double tip = test::random_sign(rng) > 0.0 ? 0.0 : kPi;
    const double from = tip - test::uniform(rng, 0.2, 1.2);
    const double to = tip + test::uniform(rng, 0.2, 1.2);
    const int steps = std::uniform_int_distribution<int>(60, 300)(rng);
    pen.go(from, to, steps, rng, &scene.strokes.emplace_back());
  }
  return scene;
}

/// Two strokes along an ellipse or a hyperbola that go back once, by a twentieth of their way or
/// so.
StrokedScene scene_with_ways_back(std::mt19937_64& rng) {
  const bool is_ellipse = test::random_sign(rng) > 0.0;
  const double a = kHalfExtent_m * (is_ellipse ? 1.0 : test::log_uniform(rng, 0.15, 1.0));
  const double b = kHalfExtent_m * test::uniform(rng, 0.25, 0.95);
  const Pen pen(is_ellipse ? ellipse(a, b) : hyperbola(a, b),
                kHalfExtent_m * test::log_uniform(rng, 1e-4, 3e-3));
  StrokedScene scene;
  scene.truth = is_ellipse ? CurveClass::Ellipse : CurveClass::Hyperbola;
  for (int k = 0; k < 2; ++k) {
    const double from = is_ellipse ? test::uniform(rng, -kPi, kPi) : test::uniform(rng, -1.7, 0.7);
    const double way = test::uniform(rng, 1.0, is_ellipse ? 2.0 : 1.0);
    const double turn = from + way * test::uniform(rng, 0.4, 0.9);
    const double back = way * test::uniform(rng, 0.03, 0.15);
    const int steps = std::uniform_int_distribution<int>(60, 200)(rng);
    const int steps_back = std::max(4, static_cast<int>(steps * back / way));
    Stroke& stroke = scene.strokes.emplace_back();
    pen.go(from, turn, steps, rng, &stroke);
    pen.go(turn, turn - back, steps_back, rng, &stroke);
    pen.go(turn - back, from + way, steps, rng, &stroke);
  }
  return scene;
}

Recognition answer_to(const StrokedScene& scene) {
  Recognizer recognizer;
  for (std::uint32_t p = 0; p < scene.strokes.size(); ++p) {
    recognizer.add({0, p}, scene.strokes[p]);
  }
  return recognizer.recognize();
}

constexpr std::uint64_t kSeedOfStroked = 2026;

/// The ellipse was found in all of these, but about the tip some chords between its points run
/// across the needle: it was taken for one that nothing touches, and "unclassified" was certain.
TEST(StrokedConics, NeedlesAreFoundByStrokesRoundTheirTips) {
  for (const std::uint32_t number : {238U, 690U, 1133U, 1623U}) {
    std::mt19937_64 rng = test::seeded_rng(kSeedOfStroked, {number});
    const StrokedScene scene = needle_scene(rng);
    const Recognition answer = answer_to(scene);
    EXPECT_EQ(answer.shape.curve_class, scene.truth) << number;
    EXPECT_EQ(answer.status, RecognitionStatus::Recognized) << number;
  }
}

/// No more answers are RECOGNIZED and wrong than their probabilities say. (One in forty was where
/// the few points of a way back counted against the conic.)
TEST(StrokedConics, AreFoundWhereTheProbeGoesBackALittle) {
  const int scenes = test::stress_count(400);
  int recognized = 0;
  int wrong = 0;
  double expected = 0.0;
  for (std::uint32_t number = 0; number < static_cast<std::uint32_t>(scenes); ++number) {
    std::mt19937_64 rng = test::seeded_rng(kSeedOfStroked, {number});
    const StrokedScene scene = scene_with_ways_back(rng);
    const Recognition answer = answer_to(scene);
    if (answer.status == RecognitionStatus::Recognized) {
      ++recognized;
      expected += 1.0 - answer.hypotheses.front().probability;
      wrong += answer.shape.curve_class == scene.truth ? 0 : 1;
    }
  }
  std::cout << "RECOGNIZED " << recognized << " of " << scenes << ", wrong " << wrong
            << ", expected " << expected << '\n';
  if (test::counts_tell()) {
    EXPECT_LE(wrong, test::most_of_poisson(expected));
  }
}

}  // namespace
}  // namespace palpate
