// Strokes along one arm of a semi-cubical parabola, where one that opens the other way, sheared and
// larger than is ever expected, is nearly the same arc.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/semi_cubical_parabola.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr auto kSemiCubical = CurveClass::SemiCubicalParabola;

/// One arm, in metres, and how far along it each stroke goes.
struct Arm {
  double a = 0.0;  ///< [m^-1/2]
  double b = 0.0;
  std::vector<std::array<double, 2>> strokes;  ///< parameters [m^1/2]
  int samples = 80;                            ///< of each
  double sigma_m = 0.0;
};

std::vector<Arm> arms() {
  return {{15.1, 0.68, {{0.0456, 0.0772}, {0.0984, 0.1236}, {0.142, 0.180}}, 80, 4e-5},
          {16.2, 0.62, {{0.0473, 0.0768}, {0.0909, 0.1298}, {0.151, 0.189}}, 80, 4e-5},
          {15.8, 0.60, {{0.0474, 0.190}}, 80, 4e-5}};
}

struct Answered {
  Recognition answer;
  double turned = 0.0;  ///< of the told axis, from the true one [rad]
};

Answered answered(const Arm& arm, const RecognizerOptions& options, std::mt19937_64& rng) {
  const SemiCubicalParabola curve{arm.a, arm.b};
  const Pose2 pose = test::pose_within(rng, 0.2);
  Recognizer recognizer(options);
  PatchContext context;
  for (const auto& [from, to] : arm.strokes) {
    std::vector<ContactSample> samples;
    for (int i = 0; i < arm.samples; ++i) {
      const double t = from + (to - from) * i / (arm.samples - 1);
      samples.push_back(
          {pose * curve.position(t) + test::normal_pair(rng, arm.sigma_m), arm.sigma_m, 0});
    }
    recognizer.add(context, samples);
    ++context.patch;
  }
  Answered result;
  result.answer = recognizer.recognize();
  result.turned = std::abs(wrap_angle(result.answer.world_T_curve.theta - pose.theta));
  return result;
}

TEST(MirroredCusps, LeaveTheClassItsProbability) {
  std::mt19937_64 rng = test::test_rng();
  const int noises = test::stress_count(60);
  for (const Arm& arm : arms()) {
    int first = 0;
    for (int i = 0; i < noises; ++i) {
      const Recognition answer = answered(arm, {}, rng).answer;
      const Hypothesis* truth = test::hypothesis_of(answer, kSemiCubical);
      // Each of eight classes is as probable beforehand, and so a true one has less than p in no
      // more than 8 p of all scenes.
      EXPECT_GT(truth == nullptr ? 0.0 : truth->probability, kNegligibleProbability)
          << i << ": " << test::said(answer);
      first += truth == answer.hypotheses.data() ? 1 : 0;
    }
    std::cout << arm.strokes.size() << " strokes: the most probable class in " << first << " of "
              << noises << "\n";
  }
}

TEST(MirroredCusps, AreNotTheGivenClassesShape) {
  std::mt19937_64 rng = test::test_rng();
  const int noises = test::stress_count(100);
  RecognizerOptions options;
  options.classes = class_bit(kSemiCubical);
  int recognized = 0;
  int mirrored = 0;
  for (const Arm& arm : arms()) {
    for (int i = 0; i < noises; ++i) {
      const auto [answer, turned] = answered(arm, options, rng);
      if (answer.status == RecognitionStatus::Recognized &&
          answer.shape.curve_class == kSemiCubical) {
        ++recognized;
        mirrored += turned > 0.5 * kPi ? 1 : 0;
      }
    }
  }
  std::cout << "RECOGNIZED " << recognized << ", mirrored " << mirrored << "\n";
  // What is RECOGNIZED leaves another shape no more than that.
  const double most = (1.0 - options.recognized_probability) * recognized;
  EXPECT_LE(mirrored, test::most_of_poisson(most)) << "of " << recognized;
}

}  // namespace
}  // namespace palpate
