// Strokes by round tips of several radii on one side of a part, which nobody states: their centres
// lie on different curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <optional>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// A part of a class, 30 mm large, stroked by tips of three radii from outside of its bends or, if
/// it has no outside, from the left of its travel; nullopt where a tip does not reach a stroke.
std::optional<Recognition> answer_by_tips(CurveClass curve_class, std::mt19937_64& rng) {
  constexpr double kSigma_m = 2e-5;
  std::array<double, 3> tips_m = {1e-4, 3e-3, 1e-2};
  std::shuffle(tips_m.begin(), tips_m.end(), rng);
  test::SceneOptions scene_options;
  scene_options.patches = 4;
  scene_options.points_per_patch = 80;
  scene_options.sigma_over_size = 0.0;
  scene_options.size_m = 0.03;
  const test::Scene scene = test::random_scene(curve_class, scene_options, rng);
  const auto curve = make_curve(curve_class, scene.values);
  RecognizerOptions options;
  options.sigma_m = kSigma_m;
  options.patience = kPatienceWithFiles;
  Recognizer recognizer(options);
  const bool has_outside =
      curve_class == CurveClass::Circle || curve_class == CurveClass::Ellipse ||
      curve_class == CurveClass::Parabola || curve_class == CurveClass::Hyperbola;
  for (std::uint32_t patch = 0; patch < scene.patches.size(); ++patch) {
    const double tip_m = tips_m[patch % tips_m.size()];
    std::vector<ContactSample> samples;
    for (std::size_t i = 0; i < scene.patches[patch].size(); ++i) {
      const LocalGeometry local = geometry(*curve, scene.t[patch][i]);
      const Vec2 along(std::cos(local.tangent_angle), std::sin(local.tangent_angle));
      const double side = has_outside ? -std::copysign(1.0, local.kappa) : 1.0;
      if (side * local.kappa * tip_m > 0.8) {
        return std::nullopt;
      }
      const Vec2 centre =
          scene.patches[patch][i] + side * tip_m * scene.world_T_curve.rotate(left_of(along));
      samples.push_back({centre + test::normal_pair(rng, kSigma_m), 0.0, 0});
    }
    recognizer.add({0, patch, tip_m}, samples);
  }
  return recognizer.recognize();
}

// Sides and travel of strokes that do not show them came from a curve through all centres, of which
// there is none: edges had no probability, and parts with strokes that hardly bend were RECOGNIZED
// as of no class.
TEST(TipsOfOtherRadii, AreOnOneSideOfThePart) {
  constexpr double kImprobable = 1e-4;
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    int scenes = 0;
    int improbable = 0;
    int recognized = 0;
    int wrong = 0;
    double stated_wrong = 0.0;
    while (scenes < test::stress_count(40)) {
      const auto answer = answer_by_tips(curve_class, rng);
      if (!answer) {
        continue;
      }
      ++scenes;
      const Hypothesis* const truth = test::hypothesis_of(*answer, curve_class);
      improbable += truth == nullptr || truth->probability < kImprobable ? 1 : 0;
      if (answer->status == RecognitionStatus::Recognized) {
        (answer->shape.curve_class == curve_class ? recognized : wrong) += 1;
        stated_wrong += test::stated_doubt(*answer);
      }
    }
    std::cout << name_of(curve_class) << ": of " << scenes << " RECOGNIZED " << recognized
              << ", as another " << wrong << " (as told " << stated_wrong << "); truth improbable "
              << improbable << '\n';
    EXPECT_LE(wrong, test::most_of_poisson(stated_wrong));
    EXPECT_LE(improbable, test::most_of_poisson(kImprobable * scenes));
  }
}

}  // namespace
}  // namespace palpate
