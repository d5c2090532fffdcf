// What a single patch can determine: precise data must make the answer certain.
#include <gtest/gtest.h>

#include <cmath>

#include "core/numerics/probability/negligible.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_curve.h"

namespace palpate {
namespace {

/// 111 samples of a parabola of a = 20 mm, over `turn_rad` of the tangent from `from_rad` (0 = the
/// vertex). Noise in units of the patch's half extent.
test::Scene patch_of_parabola(double from_rad, double turn_rad, double sigma_over_size,
                              std::mt19937_64& rng) {
  const double a = 0.02;
  // (a t^2, 2 a t): the tangent is turned by atan(t) from that at the vertex.
  const double t0 = std::tan(from_rad);
  const double t1 = std::tan(from_rad + turn_rad);
  const Curve parabola = make_curve(CurveClass::Parabola, {a, 0.0, 0.0}).value();
  const double length = arc_length(parabola, t0, t1);
  const test::Stroke stroke{parameter_at_arc_length(parabola, t0, 0.5 * length), length, 111, 1};
  const double half_extent = 0.5 * (position(parabola, t1) - position(parabola, t0)).norm();
  return test::touched_curve(parabola, {0.1, -0.2, 0.7}, {&stroke, 1},
                             sigma_over_size * half_extent, rng);
}

TEST(OnePatch, SixtyDegreesOfAParabolaAtAHundredThousandthAreRecognized) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kTurn = kPi / 3.0;
  constexpr int kPatches = 20;
  int recognised = 0;
  for (int i = 0; i < kPatches; ++i) {
    // From symmetric about the vertex to one arm only.
    const double from = -0.5 * kTurn + 0.5 * kTurn * i / (kPatches - 1);
    const test::Scene scene = patch_of_parabola(from, kTurn, 1e-5, rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    ASSERT_FALSE(answer.hypotheses.empty());
    EXPECT_EQ(answer.shape.curve_class, CurveClass::Parabola) << i;
    recognised += answer.status == RecognitionStatus::Recognized &&
                          answer.shape.curve_class == CurveClass::Parabola
                      ? 1
                      : 0;
    if (answer.shape.curve_class == CurveClass::Parabola) {
      EXPECT_NEAR(answer.shape.values[0], 0.02, 5.0 * std::sqrt(answer.covariance(0, 0))) << i;
    }
  }
  // By chance, noise puts another conic at two standard deviations one time in twenty.
  EXPECT_GE(recognised, kPatches - 2);
}

// Certainty grows with the precision of the data, without a limit below 1.
TEST(OnePatch, CertaintyOfAParabolaGrowsWithPrecision) {
  constexpr int kPatches = 20;
  double before = 0.0;
  for (const double level : {1e-4, 1e-5, 1e-6}) {
    std::mt19937_64 rng = test::test_rng();
    double doubt = 0.0;
    for (int i = 0; i < kPatches; ++i) {
      const test::Scene scene = patch_of_parabola(-kPi / 6.0, kPi / 3.0, level, rng);
      const Recognition answer = test::recognise(scene, scene.sigma_m);
      const Hypothesis* parabola = test::hypothesis_of(answer, CurveClass::Parabola);
      ASSERT_NE(parabola, nullptr);
      doubt += (1.0 - parabola->probability) / kPatches;
    }
    if (before > 0.0) {
      // The Occam factor of the rivals' extra parameter is proportional to the noise: a factor of
      // ten per step.
      EXPECT_LT(doubt, 0.3 * before) << level;
    }
    before = doubt;
  }
}

// More samples than are kept one by one: neighbours' means lie inside the bend, all of them. A mean
// of 32 is off by 2.9e-6 of the radius, and all together tell it to 7e-8.
TEST(OnePatch, MeansOfManySamplesTellNoSmallerCurve) {
  std::mt19937_64 rng = test::test_rng();
  constexpr int kStrokes = 20;
  constexpr int kSamples = 20000;
  double squares = 0.0;
  for (int i = 0; i < kStrokes; ++i) {
    const Curve circle = make_curve(CurveClass::Circle, {0.03, 0.0, 0.0}).value();
    const test::Stroke stroke{0.0, 5.2 * 0.03, kSamples, 1};
    const test::Scene scene =
        test::touched_curve(circle, {0.1, -0.2, 0.7}, {&stroke, 1}, 1e-5 * 0.03, rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    ASSERT_EQ(answer.status, RecognitionStatus::Recognized) << i;
    ASSERT_EQ(answer.shape.curve_class, CurveClass::Circle) << i;
    const double error = answer.shape.values[0] - 0.03;
    squares += error * error / answer.covariance(0, 0);
  }
  EXPECT_LE(squares, most_of_noise(kStrokes));
}

}  // namespace
}  // namespace palpate
