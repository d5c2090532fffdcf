// Single touches that lie closer together than their noise, all along a curve.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "tests/support/answered_touches.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kRadius = 0.03;      // [m]
constexpr double kTouchSigma = 2e-5;  // [m]

/// So many touches anywhere on an arc of the circle, of that angle, in no order.
Recognition answer_on_arc(int count, double angle, const Pose2& pose, std::mt19937_64& rng) {
  std::vector<Vec2> touches_m;
  for (int i = 0; i < count; ++i) {
    const double t = test::uniform(rng, 0.0, angle);
    const Vec2 place_m = pose * Vec2(kRadius * Vec2(std::cos(t), std::sin(t)));
    touches_m.push_back(place_m + test::normal_pair(rng, kTouchSigma));
  }
  RecognizerOptions options;
  options.memory.most_lone_touches = touches_m.size();
  return test::answer_to_touches(touches_m, kTouchSigma, options);
}

/// Touches that are close together by chance were once taken for one place: the mean of those that
/// noise had moved to one side of the curve was no mean of the curve, and lay outside its noise.
TEST(DenseTouches, AreOfTheCurveTheyLieAlong) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(20);
  double squares = 0.0;
  int known = 0;
  for (int i = 0; i < scenes; ++i) {
    const int count = i % 2 == 0 ? 2000 : 6000;
    const double angle = i % 4 < 2 ? 1.2 : 2.0 * kPi;
    const Pose2 pose = test::pose_within(rng, 0.5);
    const Recognition answer = answer_on_arc(count, angle, pose, rng);
    ASSERT_FALSE(answer.hypotheses.empty());
    EXPECT_NE(answer.doubt, Doubt::Misfit)
        << count << " over " << angle << ": " << test::said(answer);
    if (answer.shape.curve_class != CurveClass::Circle) {
      EXPECT_NE(answer.status, RecognitionStatus::Recognized) << test::said(answer);
      continue;
    }
    ++known;
    const double error_m = answer.shape.values[0] - kRadius;
    squares += error_m * error_m / answer.covariance(0, 0);
  }
  std::cout << "circles " << known << " of " << scenes << ", squares " << squares << "\n";
  EXPECT_GE(known, 0.8 * scenes - 1);
  // The sum of so many squares of normal errors is larger once in ten thousand runs.
  EXPECT_LE(squares, known + 5.0 * std::sqrt(2.0 * known));
}

}  // namespace
}  // namespace palpate
