// Both arms of narrow hyperbolas, wedges with a rounded edge, which splines fit nearly as well.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/hyperbola.h"
#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Two strokes on either arm, by the parameter of the hyperbola.
constexpr double kStrokes[][2] = {{-2.5, -2.0}, {-2.3, -1.7}, {1.7, 2.2}, {2.0, 2.5}};
constexpr int kSamples = 80;

Recognition touched(const Hyperbola& hyperbola, double sigma_m, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  Recognizer recognizer;
  for (std::uint32_t patch = 0; patch < std::size(kStrokes); ++patch) {
    const auto& [begin, end] = kStrokes[patch];
    std::vector<ContactSample> samples;
    for (int i = 0; i < kSamples; ++i) {
      const double t = begin + (end - begin) * i / (kSamples - 1.0);
      samples.push_back({hyperbola.position(t) + Vec2(noise(rng), noise(rng)), sigma_m, 0});
    }
    recognizer.add({0, patch}, samples);
  }
  return recognizer.recognize();
}

// Under a prior whose only size is that of a hyperbola's tip, a part three hundred tips long has
// e^-30 of it, and a spline all of the answer.
TEST(NarrowHyperbolas, TouchedOnTheirArmsAreNoSplines) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kA_m = 5e-3;
  const int scenes = test::stress_count(40);
  for (const double ratio : {0.05, 0.1, 0.4}) {
    const Hyperbola hyperbola{kA_m, ratio * kA_m};
    // Noise at which the strokes tell the arms' bend, a spline's as well.
    const double sigma_m = 0.01 * ratio * kA_m;
    int right = 0;
    int wrong = 0;
    double stated_wrong = 0.0;
    for (int i = 0; i < scenes; ++i) {
      const Recognition answer = touched(hyperbola, sigma_m, rng);
      if (answer.status == RecognitionStatus::Recognized) {
        (answer.shape.curve_class == CurveClass::Hyperbola ? right : wrong) += 1;
        stated_wrong += 1.0 - answer.hypotheses.front().probability;
      }
    }
    std::cout << "b / a " << ratio << ": of " << scenes << " RECOGNIZED " << right
              << ", as another " << wrong << " (as told " << stated_wrong << ")\n";
    EXPECT_LE(wrong, test::most_of_poisson(stated_wrong));
  }
}

}  // namespace
}  // namespace palpate
