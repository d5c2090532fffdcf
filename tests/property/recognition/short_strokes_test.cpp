// Strokes of many samples that are not much longer than their noise.
#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kStrokeSigma = 1e-4;  // [m]

/// A straight stroke of evenly spaced samples.
Recognition answer_to_stroke(double deviations, int count, const Pose2& pose,
                             std::mt19937_64& rng) {
  std::vector<ContactSample> samples;
  for (int i = 0; i < count; ++i) {
    const Vec2 place(kStrokeSigma * deviations * i / (count - 1), 0.0);
    samples.push_back({pose * Vec2(place + test::normal_pair(rng, kStrokeSigma)), kStrokeSigma, 0});
  }
  Recognizer recognizer;
  recognizer.add(PatchContext{}, samples);
  return recognizer.recognize();
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
