// One spike as the first or last sample of a stroke, as a probe makes where it comes or leaves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kImprobable = 1e-4;
constexpr double kSpike = 10.0;  // of the noise's deviations

/// A part of a class, stroked in two places, with a spike at an end of one of the strokes.
Recognition answer_with_spike(CurveClass curve_class, std::mt19937_64& rng) {
  const test::Scene scene = test::random_scene(curve_class, {}, rng);
  RecognizerOptions options;
  options.sigma_m = scene.sigma_m;
  Recognizer recognizer(options);
  for (std::uint32_t patch = 0; patch < scene.patches.size(); ++patch) {
    std::vector<Vec2> places = scene.patches[patch];
    if (patch == 0) {
      const bool is_first = test::uniform(rng, 0.0, 1.0) < 0.5;
      const std::size_t end = is_first ? 0 : places.size() - 1;
      const Vec2 along = is_first ? places[4] - places[0] : places[end] - places[end - 4];
      const double off_m = test::uniform(rng, 0.0, 1.0) < 0.5 ? -kSpike : kSpike;
      places[end] += off_m * scene.sigma_m * left_of(along).normalized();
    }
    std::vector<ContactSample> samples;
    for (const Vec2& place : places) {
      samples.push_back({place, 0.0, 0});
    }
    recognizer.add({0, patch, 0.0}, samples);
  }
  return recognizer.recognize();
}

// A quartic through sixteen samples bends to a spike at its end, and so did cusps and loops: parts
// were RECOGNIZED as such, or as of no class.
TEST(SpikesAtEnds, AreSetAside) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    const int scenes = test::stress_count(200);
    int improbable = 0;
    int wrong = 0;
    double stated_wrong = 0.0;
    for (int i = 0; i < scenes; ++i) {
      const Recognition answer = answer_with_spike(curve_class, rng);
      const Hypothesis* const truth = test::hypothesis_of(answer, curve_class);
      improbable += truth == nullptr || truth->probability < kImprobable ? 1 : 0;
      if (answer.status == RecognitionStatus::Recognized) {
        wrong += answer.shape.curve_class == curve_class ? 0 : 1;
        stated_wrong += test::stated_doubt(answer);
      }
    }
    std::cout << name_of(curve_class) << ": of " << scenes << " RECOGNIZED as another " << wrong
              << " (as told " << stated_wrong << "); truth improbable " << improbable << '\n';
    EXPECT_LE(wrong, test::most_of_poisson(stated_wrong));
    EXPECT_LE(improbable, test::most_of_poisson(kImprobable * scenes));
  }
}

}  // namespace
}  // namespace palpate
