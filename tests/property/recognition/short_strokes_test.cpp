// Strokes of many samples that are not much longer than their noise.
#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <vector>

#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kStrokeSigma = 1e-4;  // [m]

/// A straight stroke of evenly spaced samples.
Recognition answer_to_stroke(double deviations, int count, const Pose2& pose,
                             std::mt19937_64& rng) {
  test::Scene scene;
  std::vector<Vec2>& stroke_m = scene.patches.emplace_back();
  for (int i = 0; i < count; ++i) {
    const Vec2 place_m(kStrokeSigma * deviations * i / (count - 1), 0.0);
    stroke_m.push_back(pose * Vec2(place_m + test::normal_pair(rng, kStrokeSigma)));
  }
  return test::recognise(scene, kStrokeSigma);
}

/// Each sample on the nearest of three branches that lie within the noise, a cubical parabola laid
/// to and fro over the stroke once explained its noise: of strokes as long as ten deviations six of
/// a hundred were RECOGNIZED as one.
TEST(ShortStrokes, AreNoCurvesLaidToAndFroOverTheirNoise) {
  constexpr double kMostWrong = 0.005;  // what is promised of all scenes
  std::mt19937_64 rng = test::test_rng();
  const int strokes = test::stress_count(400);
  int wrong = 0;
  for (int i = 0; i < strokes; ++i) {
    const double deviations = i % 2 == 0 ? 10.0 : 20.0;
    const Recognition answer = answer_to_stroke(deviations, 300, test::pose_within(rng, 0.1), rng);
    if (test::is_recognized(answer) && answer.shape.curve_class != CurveClass::Line) {
      ++wrong;
      std::cout << deviations << " deviations: " << test::said(answer) << "\n";
    }
  }
  EXPECT_LE(wrong, test::most_of_poisson(kMostWrong * strokes));
}

}  // namespace
}  // namespace palpate
