// Many short strokes all over a curve, as of a finger that taps along: some run through the place
// where it crosses itself, or beside its cusp, where noise puts samples next to the other strand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "core/curves/cubic_spline.h"
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

// Four strokes on one arm of a looped spline, and one on the other: the search tried the arms of
// four strokes in all ways, by their order. Where the one came last, the curve was lost.
TEST(FiveStrokes, AreOfTheirCurveInAnyOrder) {
  constexpr double kSigma_m = 2e-5;
  constexpr int kSamples = 90;
  const CubicSpline spline{4.39, 0.0404, -0.1273};  // about 50 mm of either arm
  const std::array<std::array<double, 2>, 5> strokes = {{{0.1616, 0.1746},
                                                         {-0.1727, -0.1088},
                                                         {-0.1524, -0.1151},
                                                         {-0.1606, -0.1448},
                                                         {-0.1923, -0.1689}}};
  std::mt19937_64 rng = test::test_rng();
  int lost = 0;
  const int scenes = test::stress_count(40);
  for (int i = 0; i < scenes; ++i) {
    std::array<std::size_t, 5> order = {0, 1, 2, 3, 4};
    std::shuffle(order.begin(), order.end(), rng);
    std::normal_distribution<double> normal(0.0, kSigma_m);
    Recognizer recognizer;
    std::uint32_t patch = 0;
    for (const std::size_t k : order) {
      std::vector<ContactSample> stroke;
      for (int j = 0; j < kSamples; ++j) {
        const double part = static_cast<double>(j) / (kSamples - 1);
        const double t = strokes[k][0] + part * (strokes[k][1] - strokes[k][0]);
        stroke.push_back({spline.position(t) + Vec2(normal(rng), normal(rng)), kSigma_m, 0});
      }
      recognizer.add({0, patch++}, stroke);
    }
    const Recognition answer = recognizer.recognize();
    lost += answer.status == RecognitionStatus::Recognized &&
                    answer.shape.curve_class != CurveClass::CubicSpline
                ? 1
                : 0;
  }
  std::cout << "of " << scenes << " orders lost " << lost << '\n';
  EXPECT_EQ(lost, 0);
}

INSTANTIATE_TEST_SUITE_P(Classes, ManyStrokes,
                         testing::Values(CurveClass::Ellipse, CurveClass::CubicalParabola,
                                         CurveClass::SemiCubicalParabola, CurveClass::CubicSpline),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
