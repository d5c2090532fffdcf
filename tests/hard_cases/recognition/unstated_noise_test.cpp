// White noise that nobody states, of strokes that are dense or short beside it: it is what all
// samples tell, not what a few leave by chance.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <utility>
#include <vector>

#include "core/curves/pose2.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

constexpr double kSigma_m = 1e-5;

/// Strokes of one part, their lengths in standard deviations of the noise.
struct StrokesOfPart {
  std::size_t strokes = 1;
  std::size_t samples = 0;  ///< of a stroke
  double length = 0.0;
  double apart = 0.0;   ///< from the beginning of a stroke to that of the next
  double radius = 0.0;  ///< 0 = a straight edge
  bool brakes = false;  ///< the probe sets off slowly and comes to rest
};

test::Scene touched(const StrokesOfPart& part, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, kSigma_m);
  test::Scene scene;
  for (std::size_t j = 0; j < part.strokes; ++j) {
    std::vector<Vec2>& stroke = scene.patches.emplace_back();
    for (std::size_t i = 0; i < part.samples; ++i) {
      const double u = static_cast<double>(i) / static_cast<double>(part.samples - 1);
      const double share = part.brakes ? u * u * (3.0 - 2.0 * u) : u;
      const double s = part.apart * static_cast<double>(j) + part.length * share;
      const double angle = part.radius > 0.0 ? s / part.radius : 0.0;
      const Vec2 place = part.radius > 0.0
                             ? Vec2(part.radius * Vec2(std::sin(angle), std::cos(angle)))
                             : Vec2(s, 0.0);
      const double x = noise(rng);
      stroke.push_back(kSigma_m * place + Vec2(x, noise(rng)));
    }
  }
  return scene;
}

// Two strokes with steps of about 0.6 deviations. Some were given the noise that one block of eight
// samples showed, of thirty: many times less than the other's.
TEST(UnstatedNoise, OfDenseStrokesIsThatOfAllSamples) {
  std::mt19937_64 rng = test::test_rng();
  int recognized = 0;
  int wrong = 0;
  double expected = 0.0;
  for (int i = 0; i < test::stress_count(150); ++i) {
    for (const bool brakes : {false, true}) {
      for (const double radius : {0.0, 200.0}) {
        for (const auto& [samples, length] : {std::pair(120U, 80.0), std::pair(240U, 150.0)}) {
          const Recognition answer = test::recognise(
              touched({2, samples, length, 3.0 * length, radius, brakes}, rng), 0.0);
          // A degree of freedom a coordinate across the path; what the sections take, and spikes
          // found by mistake, is less than a quarter. Of its logarithm, five deviations.
          const double dof = 0.75 * 2.0 * samples;
          EXPECT_NEAR(std::log(answer.sigma_m / kSigma_m), 0.0,
                      kNegligibleDeviations / std::sqrt(2.0 * dof))
              << i << " " << brakes << " " << radius << " " << samples;
          if (answer.status == RecognitionStatus::Recognized) {
            const CurveClass truth = radius > 0.0 ? CurveClass::Circle : CurveClass::Line;
            ++recognized;
            wrong += answer.shape.curve_class == truth ? 0 : 1;
            expected += test::stated_doubt(answer);
          }
        }
      }
    }
  }
  if (test::counts_tell()) {
    EXPECT_GE(recognized, 300);  // where they are long enough to tell, half of all
    EXPECT_LE(wrong, test::most_of_poisson(expected));
  }
}

// A polynomial of degree 9 went through the noise of 20 samples, and the noise of the other samples
// was form beside what it left. Or one of some short sections was quiet by chance, and the others
// were cut to single samples. Ten deviations of an edge may look like an arc of another class, but
// nothing shows that they are of none.
TEST(UnstatedNoise, OfShortStrokesOfAnEdgeMakesItNoPartOfNoClass) {
  std::mt19937_64 rng = test::test_rng();
  for (const auto& [strokes, samples] :
       {std::pair(1U, 18U), std::pair(1U, 30U), std::pair(2U, 20U), std::pair(3U, 20U)}) {
    int recognized = 0;
    int wrong = 0;
    int of_no_class = 0;
    double expected_wrong = 0.0;  // by the probabilities that were told
    for (int i = 0; i < test::stress_count(1500); ++i) {
      const Recognition answer =
          test::recognise(touched({strokes, samples, 10.0, 200.0, 0.0, false}, rng), 0.0);
      if (answer.status == RecognitionStatus::Recognized) {
        ++recognized;
        wrong += answer.shape.curve_class == CurveClass::Line ? 0 : 1;
        of_no_class += answer.shape.curve_class == CurveClass::Unclassified ? 1 : 0;
        expected_wrong += test::stated_doubt(answer);
      }
    }
    std::cout << strokes << " strokes of " << samples << ": RECOGNIZED " << recognized << ", wrong "
              << wrong << ", of no class " << of_no_class << '\n';
    if (test::counts_tell()) {
      EXPECT_LE(of_no_class, test::most_of_poisson(expected_wrong));
    }
  }
}

// No polynomial leaves anything of five samples. Free paths through all points were then weighed as
// if there were no noise, beside which no class can be: edges were certainly of no class, and
// circles ellipses, whose further parameters were told by no noise as well.
TEST(UnstatedNoise, OfStrokesTooShortToShowItIsWhatPathsAndClassesLeave) {
  std::mt19937_64 rng = test::test_rng();
  struct Case {
    StrokesOfPart part;
    bool tells_the_class;
  };
  for (const Case& one :
       {Case{{5, 7, 18.0, 36.0, 0.0, false}, false}, Case{{5, 5, 40.0, 80.0, 80.0, false}, true},
        Case{{3, 7, 18.0, 36.0, 36.0, false}, false}}) {
    const CurveClass truth = one.part.radius > 0.0 ? CurveClass::Circle : CurveClass::Line;
    const int parts = test::stress_count(150);
    int right = 0;
    int wrong = 0;
    double expected = 0.0;
    for (int i = 0; i < parts; ++i) {
      const Recognition answer = test::recognise(touched(one.part, rng), 0.0);
      if (answer.status == RecognitionStatus::Recognized) {
        ++(answer.shape.curve_class == truth ? right : wrong);
        expected += test::stated_doubt(answer);
      }
    }
    std::cout << one.part.strokes << " strokes of " << one.part.samples << ": " << right
              << " right, " << wrong << " wrong, by what is told " << expected << '\n';
    EXPECT_LE(wrong, test::most_of_poisson(expected));
    if (one.tells_the_class && test::counts_tell()) {
      EXPECT_GE(right, parts / 2);
    }
  }
}

// Samples closer than their noise: the chords between neighbours lie in all directions. A free path
// that was held against distances across these went nearer to them than any class can, and two
// strokes of an edge were of no class in 14 to 19 of 2,400.
TEST(UnstatedNoise, OfSamplesThatAreCloserIsNoPath) {
  std::mt19937_64 rng = test::test_rng();
  int of_no_class = 0;
  double expected = 0.0;
  for (const double step : {1.0, 2.0}) {
    for (const std::size_t samples : {6U, 8U, 10U}) {
      const double length = step * static_cast<double>(samples - 1);
      for (int i = 0; i < test::stress_count(400); ++i) {
        const Recognition answer =
            test::recognise(touched({2, samples, length, 2.0 * length, 0.0, false}, rng), 0.0);
        if (answer.status == RecognitionStatus::Recognized) {
          of_no_class += answer.shape.curve_class == CurveClass::Unclassified ? 1 : 0;
          expected += test::stated_doubt(answer);
        }
      }
    }
  }
  EXPECT_LE(of_no_class, test::most_of_poisson(expected));
}

// One stroke of an ellipse of 30 x 20 mm over 1.3 rad. A polynomial that so few samples allow
// leaves form, which was taken for what noise leaves: a spline that went nearer to them was
// certain.
TEST(UnstatedNoise, OfFewSamplesIsNotWhatAPolynomialMissesOfThem) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kQuiet_m = 1.5e-6;
  int wrong = 0;
  double expected = 0.0;
  for (int i = 0; i < test::stress_count(200); ++i) {
    for (const std::size_t samples : {8U, 9U, 10U, 11U}) {
      const double first = test::uniform(rng, 0.0, 2.0 * kPi);
      std::vector<Vec2> exact;
      for (std::size_t k = 0; k < samples; ++k) {
        const double t = first + 1.3 * static_cast<double>(k) / static_cast<double>(samples - 1);
        exact.emplace_back(30e-3 * std::cos(t), 20e-3 * std::sin(t));
      }
      test::Scene scene;
      scene.patches.push_back(test::with_noise(exact, kQuiet_m, rng));
      const Recognition answer = test::recognise(scene, 0.0);
      if (answer.status == RecognitionStatus::Recognized) {
        wrong += answer.shape.curve_class == CurveClass::Ellipse ? 0 : 1;
        expected += test::stated_doubt(answer);
      }
    }
  }
  EXPECT_LE(wrong, test::most_of_poisson(expected));
}

// Two strokes of 6 to 12 samples, each round most of an ellipse: steps of 20 to 60 degrees, as a
// coordinate measuring machine takes. By noise as large as what free paths leave of such steps, the
// ellipse was one that no probe touches so, or the search ended beside it: 4 to 8 of 400 had a
// probability below 1e-4, and a spline or circle was certain.
TEST(UnstatedNoise, OfCoarseStrokesRoundAnEllipseIsNotTheSizeOfTheirSteps) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kImprobable = 1e-4;
  const int parts = test::stress_count(400);
  int improbable = 0;
  int right = 0;
  int wrong = 0;
  double expected = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double flat = test::uniform(rng, 0.2, 0.9);
    test::Scene scene;
    for (int stroke = 0; stroke < 2; ++stroke) {
      const double first = test::uniform(rng, 0.0, 2.0 * kPi);
      const double turn = test::uniform(rng, 2.5, 4.0);
      const int samples = 6 + static_cast<int>(test::uniform(rng, 0.0, 7.0));
      std::vector<Vec2> exact;
      double t = first;
      for (int k = 0; k < samples; ++k) {
        exact.emplace_back(30e-3 * std::cos(t), 30e-3 * flat * std::sin(t));
        t += turn / samples * test::uniform(rng, 0.5, 1.5);
      }
      scene.patches.push_back(test::with_noise(exact, kSigma_m, rng));
    }
    const Recognition answer = test::recognise(scene, 0.0);
    for (const Hypothesis& hypothesis : answer.hypotheses) {
      improbable += hypothesis.shape.curve_class == CurveClass::Ellipse &&
                            hypothesis.probability < kImprobable
                        ? 1
                        : 0;
    }
    if (answer.status == RecognitionStatus::Recognized) {
      ++(answer.shape.curve_class == CurveClass::Ellipse ? right : wrong);
      expected += test::stated_doubt(answer);
    }
  }
  std::cout << right << " right, " << wrong << " wrong, by what is told " << expected << "; "
            << improbable << " improbable\n";
  EXPECT_LE(improbable, test::most_of_poisson(kImprobable * parts));
  EXPECT_LE(wrong, test::most_of_poisson(expected));
  if (test::counts_tell()) {
    EXPECT_GE(2 * right, parts);
  }
}

// One stroke of ten samples over a fifth of a nearly round ellipse. The search leaves a
// semi-cubical parabola at a poor fit, and its prior leads to a place that leaves a tenth as much.
// By the noise of the poor fit that was worth e^48 and not a power of what is left: of 1 to 3 of
// 100 parts that class was certain.
TEST(UnstatedNoise, OfAPoorFitDoesNotWeighABetterMode) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kNoise_m = 4e-6;
  constexpr double kImprobable = 1e-4;
  const int parts = test::stress_count(300);
  int improbable = 0;
  for (int i = 0; i < parts; ++i) {
    const double first = test::uniform(rng, 0.0, 2.0 * kPi);
    std::vector<Vec2> exact;
    for (int k = 0; k < 10; ++k) {
      const double t = first + 0.4 * kPi * k / 9.0;
      exact.emplace_back(12.5e-3 * std::cos(t), 11.1e-3 * std::sin(t));
    }
    test::Scene scene;
    scene.patches.push_back(test::with_noise(exact, kNoise_m, rng));
    const Recognition answer = test::recognise(scene, 0.0);
    const Hypothesis* truth = test::hypothesis_of(answer, CurveClass::Ellipse);
    improbable += truth == nullptr || truth->probability < kImprobable ? 1 : 0;
  }
  EXPECT_LE(improbable, test::most_of_poisson(kImprobable * parts));
}

}  // namespace
}  // namespace palpate
