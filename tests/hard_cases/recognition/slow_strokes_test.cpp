// Strokes whose samples lie much closer together than their noise, as at a few millimetres a second
// and a kilohertz, with spikes among them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/dwells.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kNoiseOfSlow_m = 25e-6;
constexpr double kStepOfSlow_m = 0.2 * kNoiseOfSlow_m;

/// Along a circle; curvature 0 = along a straight edge. [1/m]
std::vector<ContactSample> slow_stroke(double curvature, double from_m, std::size_t count,
                                       std::mt19937_64& rng) {
  constexpr double kSpikeShare = 0.03;
  std::normal_distribution<double> noise(0.0, kNoiseOfSlow_m);
  std::bernoulli_distribution is_spike(kSpikeShare);
  std::vector<ContactSample> stroke;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = from_m + kStepOfSlow_m * static_cast<double>(i);
    const Vec2 place = curvature > 0.0
                           ? Vec2(std::sin(curvature * s), std::cos(curvature * s)) / curvature
                           : Vec2(s, 0.0);
    ContactSample sample{place + Vec2(noise(rng), noise(rng)), kNoiseOfSlow_m, 0};
    if (is_spike(rng)) {
      const double direction = test::uniform(rng, -kPi, kPi);
      sample.position_m += kNoiseOfSlow_m * test::uniform(rng, 30.0, 100.0) *
                           Vec2(std::cos(direction), std::sin(direction));
    }
    stroke.push_back(sample);
  }
  return stroke;
}

TEST(SlowStrokes, AreNoDwellsForTheirSpikes) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(20); ++i) {
    std::vector<StoredSample> samples;
    for (const ContactSample& sample : slow_stroke(0.0, 0.0, 600, rng)) {
      samples.push_back({sample.position_m, sample.sigma_m});
    }
    EXPECT_TRUE(dwells_of(samples, 0.0).empty()) << i;
  }
}

/// Three strokes of a part, with an answer after every so many samples of a stroke. Of those that
/// are certain no more are wrong than their probability says.
void expect_few_cut(std::size_t of_update) {
  std::mt19937_64 rng = test::test_rng();
  constexpr std::size_t kSamples = 600;
  int answers = 0;
  int cut = 0;
  int recognized = 0;
  int wrong = 0;
  for (int i = 0; i < test::stress_count(20); ++i) {
    const bool is_round = i % 2 == 0;
    const double curvature = is_round ? 1.0 / test::log_uniform(rng, 2e-3, 10e-3) : 0.0;
    const CurveClass truth = is_round ? CurveClass::Circle : CurveClass::Line;
    Recognizer recognizer;
    for (std::uint32_t p = 0; p < 3; ++p) {
      const std::vector<ContactSample> stroke = slow_stroke(curvature, 5e-3 * p, kSamples, rng);
      for (std::size_t begin = 0; begin < kSamples; begin += of_update) {
        recognizer.add({0, p}, std::span(stroke).subspan(begin, of_update));
        const Recognition answer = recognizer.recognize();
        ++answers;
        cut += answer.work.was_cut() ? 1 : 0;
        if (answer.status == RecognitionStatus::Recognized) {
          ++recognized;
          wrong += answer.shape.curve_class == truth ? 0 : 1;
        }
      }
    }
  }
  std::cout << "of " << answers << " answers cut " << cut << ", RECOGNIZED " << recognized
            << ", wrong " << wrong << '\n';
  if (test::counts_tell()) {
    EXPECT_LE(20 * cut, answers);
    EXPECT_LE(wrong, test::most_of_poisson(0.05 * recognized));
  }
}

TEST(SlowStrokes, EndInNoWorkLimitForTheirSpikes) { expect_few_cut(100); }

TEST(SlowStrokes, EndInNoWorkLimitWhereTheyComeAtOnce) { expect_few_cut(600); }

}  // namespace
}  // namespace palpate
