// Answers where only some classes are asked for.
#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>

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

}  // namespace
}  // namespace palpate
