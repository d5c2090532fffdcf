// Answers where only some classes are asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/semi_cubical_parabola.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Arcs that are hardly told from those of a class's limit, a parabola's or a line's, are of the
/// class all the same where that is the only one asked for.
TEST(WantedClasses, AreToldAtTheirLimitsToo) {
  int recognized = 0;
  int none = 0;
  double expected_wrong = 0.0;
  const int scenes = test::stress_count(600);
  for (int i = 0; i < scenes; ++i) {
    const test::Scene scene = test::scene_from(test::classes_only(test::even_prior()),
                                               test::test_seed(), static_cast<std::uint32_t>(i))
                                  .scene;
    RecognizerOptions options;
    options.classes = 1U << static_cast<unsigned>(scene.curve_class);
    const Recognition answer = test::recognise(scene, scene.sigma_m, options);
    for (const Hypothesis& hypothesis : answer.hypotheses) {
      const CurveClass curve_class = hypothesis.shape.curve_class;
      EXPECT_TRUE(curve_class == scene.curve_class || curve_class == CurveClass::Unclassified) << i;
    }
    if (answer.status == RecognitionStatus::Recognized) {
      ++recognized;
      none += answer.shape.curve_class == CurveClass::Unclassified ? 1 : 0;
      expected_wrong += 1.0 - answer.hypotheses.front().probability;
    }
  }
  std::cout << "of " << scenes << ": RECOGNIZED " << recognized << ", as none " << none << '\n';
  EXPECT_LE(none, test::most_of_poisson(expected_wrong));
}

/// Strokes along an edge, which every class has arcs for: its shape is not told.
TEST(WantedClasses, AStraightPartTellsNoShapeOfAnother) {
  constexpr double kSigma = 3e-5;
  const int noises = test::stress_count(60);
  for (const CurveClass curve_class : kCurveClasses) {
    if (curve_class == CurveClass::Line) {
      continue;
    }
    int recognized = 0;
    for (int i = 0; i < noises; ++i) {
      std::mt19937_64 rng = test::seeded_rng(test::test_seed(), {static_cast<std::uint32_t>(i)});
      std::normal_distribution<double> normal(0.0, kSigma);
      RecognizerOptions options;
      options.classes = class_bit(curve_class);
      Recognizer recognizer(options);
      PatchContext context;
      for (const double from : {-0.02, 0.01}) {
        std::vector<ContactSample> samples;
        for (int k = 0; k < 80; ++k) {
          const double along = from + 0.01 * k / 79.0 + normal(rng);
          samples.push_back(
              {Vec2(0.8 * along, 0.6 * along) + normal(rng) * Vec2(-0.6, 0.8), kSigma, 0});
        }
        recognizer.add(context, samples);
        ++context.patch;
      }
      const Recognition answer = recognizer.recognize();
      recognized +=
          answer.status == RecognitionStatus::Recognized && answer.shape.curve_class == curve_class
              ? 1
              : 0;
    }
    EXPECT_EQ(recognized, 0) << static_cast<int>(curve_class);
  }
}

/// Strokes on one arm of a semi-cubical parabola, away from its cusp, that leave much of its shape
/// open: arcs of others fit as well, by chance a little better, and far from where the class is
/// expected.
TEST(WantedClasses, TheOnlyOneIsToldAsFarAsMostOfItIs) {
  int recognized = 0;
  int far_off = 0;
  const int scenes = test::stress_count(600);
  for (int i = 0; i < scenes; ++i) {
    std::mt19937_64 rng = test::seeded_rng(test::test_seed(), {static_cast<std::uint32_t>(i)});
    SemiCubicalParabola curve;
    curve.a = test::log_uniform(rng, 0.3, 30.0);
    curve.b = test::uniform(rng, -0.5, 0.5);
    const Pose2 world_T_curve{test::uniform(rng, -1.0, 1.0), test::uniform(rng, -1.0, 1.0),
                              test::uniform(rng, -kPi, kPi)};
    const double middle = test::uniform(rng, 0.6, 2.0) / curve.a;
    const double sigma_m = test::log_uniform(rng, 1e-5, 1e-3) * middle * middle;
    std::normal_distribution<double> normal(0.0, sigma_m);
    RecognizerOptions options;
    options.classes = class_bit(CurveClass::SemiCubicalParabola);
    Recognizer recognizer(options);
    for (std::uint32_t patch = 0; patch < 2; ++patch) {
      const double from = middle * test::uniform(rng, 0.8, 1.0);
      const double to = middle * test::uniform(rng, 1.05, 1.3);
      std::vector<ContactSample> stroke;
      constexpr int kSamples = 100;
      for (int k = 0; k < kSamples; ++k) {
        const double t = from + (to - from) * k / (kSamples - 1);
        const Vec2 place = world_T_curve * curve.derivatives(t).position;
        stroke.push_back({place + Vec2(normal(rng), normal(rng)), sigma_m, 0});
      }
      recognizer.add({0, patch}, stroke);
    }
    const Recognition answer = recognizer.recognize();
    if (answer.status != RecognitionStatus::Recognized ||
        answer.shape.curve_class != CurveClass::SemiCubicalParabola) {
      continue;
    }
    ++recognized;
    const double off = std::abs(answer.shape.values[0] - curve.a);
    far_off += off > kNegligibleDeviations * std::sqrt(answer.covariance(0, 0)) ? 1 : 0;
  }
  std::cout << "of " << scenes << ": RECOGNIZED " << recognized << ", a far off " << far_off
            << '\n';
  // As much of it may be elsewhere as RECOGNIZED leaves to doubt.
  const double elsewhere = 1.0 - RecognizerOptions{}.recognized_probability;
  EXPECT_LE(far_off, test::most_of_poisson(elsewhere * recognized));
}

}  // namespace
}  // namespace palpate
