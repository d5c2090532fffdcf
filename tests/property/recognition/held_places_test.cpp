// A probe that is held at each of some places while it is read several times, its noise not stated:
// means stand for the readings of a place, and these are touches in no order.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/samples/work_limit.h"
#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kLongAxis = 0.03;   // half of it [m]
constexpr double kShortAxis = 0.02;  // likewise

Recognition answer_to_held(const std::vector<Vec2>& places, int readings, double sigma_m,
                           std::mt19937_64& rng, const RecognizerOptions& options = {},
                           PatchContext context = {}) {
  Recognizer recognizer(options);
  for (const Vec2& place : places) {
    std::vector<ContactSample> samples;
    for (int i = 0; i < readings; ++i) {
      samples.push_back({place + test::normal_pair(rng, sigma_m), 0.0, 0});
    }
    recognizer.add(context, samples);
    ++context.patch;
  }
  return recognizer.recognize();
}

/// More than half a turn round an ellipse, by noise of less than a thousandth of its size: no other
/// class is near. (Scatter may still look like a part that deviates from it, once in some
/// hundreds.)
TEST(HeldPlaces, AreSearchedWithinTheWorkOfStrokes) {
  std::mt19937_64 rng = test::test_rng();
  const int parts = test::stress_count(40);
  for (int part = 0; part < parts; ++part) {
    const int count = std::uniform_int_distribution(9, 40)(rng);
    const int readings = std::uniform_int_distribution(5, 50)(rng);
    const double sigma_m = kShortAxis * std::pow(10.0, test::uniform(rng, -4.0, -3.0));
    const Pose2 pose = test::pose_within(rng, 0.5);
    const double first = test::uniform(rng, -kPi, kPi);
    std::vector<Vec2> places;
    for (int i = 0; i < count; ++i) {
      const double angle = first + 1.1 * kPi * i / (count - 1);
      places.push_back(pose * Vec2(kLongAxis * std::cos(angle), kShortAxis * std::sin(angle)));
    }
    const Recognition answer = answer_to_held(places, readings, sigma_m, rng);
    EXPECT_TRUE(answer.doubt != Doubt::WorkLimit && answer.shape.curve_class == CurveClass::Ellipse)
        << "part " << part << ", " << count << " places, " << readings
        << " readings: " << test::said(answer);
  }
}

/// A boss touched by a round tip at places all round it, each read two to four times: the scatter
/// of so few readings is no travel, on one side of which the tip would lie.
TEST(HeldPlaces, OfRoundTipsHaveNoTravel) {
  constexpr double kTipM = 0.003;
  std::mt19937_64 rng = test::test_rng(1);
  const int parts = test::stress_count(60);
  int recognized = 0;
  for (int part = 0; part < parts; ++part) {
    const int count = std::uniform_int_distribution(9, 24)(rng);
    const int readings = std::uniform_int_distribution(2, 4)(rng);
    const double sigma_m = kShortAxis * std::pow(10.0, test::uniform(rng, -4.0, -3.3));
    RecognizerOptions options;
    options.sigma_m = part % 2 == 0 ? sigma_m : 0.0;
    options.touched_from = TouchedFrom::Outside;
    options.patience = kPatienceWithFiles;
    const Pose2 pose = test::pose_within(rng, 0.5);
    std::vector<Vec2> centres;
    for (const double angle : test::angles_around(count, rng)) {
      const Vec2 normal =
          Vec2(kShortAxis * std::cos(angle), kLongAxis * std::sin(angle)).normalized();
      centres.push_back(pose * (Vec2(kLongAxis * std::cos(angle), kShortAxis * std::sin(angle)) +
                                kTipM * normal));
    }
    const Recognition answer =
        answer_to_held(centres, readings, sigma_m, rng, options, {0, 0, kTipM});
    EXPECT_NE(answer.doubt, Doubt::WorkLimit) << part;
    ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse)
        << "part " << part << ", " << count << " places, " << readings
        << " readings: " << test::said(answer);
    if (answer.status == RecognitionStatus::Recognized) {
      ++recognized;
      EXPECT_NEAR(answer.shape.values[0], kLongAxis,
                  kNegligibleDeviations * std::sqrt(answer.covariance(0, 0)))
          << part;
    }
  }
  if (test::counts_tell()) {
    EXPECT_GE(recognized, 0.92 * parts);  // what is asked of all curves that the samples determine
  }
}

}  // namespace
}  // namespace palpate
