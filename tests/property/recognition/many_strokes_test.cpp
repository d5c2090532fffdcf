// Many short strokes all over a curve, as of a finger that taps along: some run through the place
// where it crosses itself, or beside its cusp, where noise puts samples next to the other strand.
#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>
#include <random>
#include <string>

#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

class ManyStrokes : public testing::TestWithParam<CurveClass> {};

TEST_P(ManyStrokes, AreOfTheCurveThatTheyAreOn) {
  int recognized = 0;
  int wrong = 0;
  double expected_wrong = 0.0;
  const int scenes = test::stress_count(200);
  for (int i = 0; i < scenes; ++i) {
    std::mt19937_64 rng = test::seeded_rng(test::test_seed(), {static_cast<std::uint32_t>(i)});
    const bool dense = i % 2 == 1;
    const test::Scene scene = test::random_scene(GetParam(),
                                                 {.patches = 30,
                                                  .points_per_patch = dense ? 40 : 12,
                                                  .sigma_over_size = dense ? 7e-4 : 2e-3,
                                                  .least_fraction = 0.03,
                                                  .most_fraction = 0.033,
                                                  .across_cusp = true},
                                                 rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    if (answer.status == RecognitionStatus::Recognized) {
      ++recognized;
      wrong += answer.shape.curve_class != scene.curve_class ? 1 : 0;
      expected_wrong += 1.0 - answer.hypotheses.front().probability;
    }
  }
  std::cout << name_of(GetParam()) << ": of " << scenes << " RECOGNIZED " << recognized
            << ", wrong " << wrong << '\n';
  EXPECT_LE(wrong, test::most_of_poisson(expected_wrong));
}

INSTANTIATE_TEST_SUITE_P(Classes, ManyStrokes,
                         testing::Values(CurveClass::Ellipse, CurveClass::CubicalParabola,
                                         CurveClass::SemiCubicalParabola, CurveClass::CubicSpline),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
