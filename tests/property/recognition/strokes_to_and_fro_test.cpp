// Strokes that go to and fro over a piece of the part, or tremble along it where they end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iostream>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "tests/support/answered_touches.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Those along which a probe may be in an order or another; lines and circles have no other side.
constexpr std::array kClasses = {CurveClass::Ellipse,
                                 CurveClass::Parabola,
                                 CurveClass::Hyperbola,
                                 CurveClass::CubicalParabola,
                                 CurveClass::SemiCubicalParabola,
                                 CurveClass::CubicSpline};

/// Where the samples of a stroke lie on its piece of the part, of 0 to 1.
using Habit = std::function<std::vector<double>(std::mt19937_64&)>;

/// So many passes over the piece, at a pace that varies tenfold.
std::vector<double> passes(int count, int samples, std::mt19937_64& rng) {
  constexpr int kPaces = 5;
  std::array<double, kPaces> paces{};
  for (double& pace : paces) pace = test::uniform(rng, -0.5, 0.5);
  std::vector<double> way = {0.0};
  for (int i = 1; i < samples; ++i) {
    const double at = static_cast<double>(i) / samples * (kPaces - 1);
    const auto k = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(k);
    way.push_back(way.back() + std::pow(10.0, (1.0 - share) * paces[k] + share * paces[k + 1]));
  }
  std::vector<double> places;
  for (const double s : way) {
    const double passed = count * s / way.back();
    places.push_back(std::abs(std::remainder(passed, 2.0)));
  }
  return places;
}

/// One pass at an even pace, and as many readings at its end by a hand that trembles.
std::vector<double> trembling(int samples, int readings, double tremble, std::mt19937_64& rng) {
  std::vector<double> places;
  for (int i = 0; i < samples; ++i) {
    places.push_back(0.9 * i / samples);
  }
  std::normal_distribution<double> law(0.9, tremble);
  for (int i = 0; i < readings; ++i) {
    places.push_back(std::clamp(law(rng), 0.0, 1.0));
  }
  return places;
}

/// Of a part of 25 mm, in strokes of some millimetres, with a noise of 10 um.
Recognition stroked(CurveClass curve_class, const Habit& habit, std::mt19937_64& rng) {
  constexpr double kSigma = 1e-5;  // [m]
  test::SceneOptions options;
  options.patches = 4;
  options.points_per_patch = 2000;
  options.sigma_over_size = 1e-9;
  options.size_m = 0.025;
  options.least_fraction = 0.1;
  const test::Scene scene = test::random_scene(curve_class, options, rng);
  RecognizerOptions with;
  with.patience = kPatienceWithFiles;
  test::Scene touched;
  for (const std::vector<Vec2>& piece : scene.patches) {
    std::vector<Vec2>& samples = touched.patches.emplace_back();
    for (const double place : habit(rng)) {
      const auto at = static_cast<std::size_t>(place * static_cast<double>(piece.size() - 1));
      samples.push_back(piece[at] + test::normal_pair(rng, kSigma));
    }
  }
  return test::recognise(touched, kSigma, with);
}

/// How many parts are most probably what they are, and that none is RECOGNIZED as of no class.
void expect_true_classes(const Habit& habit) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(20);
  int all = 0;
  int first = 0;
  for (const CurveClass curve_class : kClasses) {
    for (int i = 0; i < scenes; ++i) {
      const Recognition answer = stroked(curve_class, habit, rng);
      const Hypothesis* truth = test::hypothesis_of(answer, curve_class);
      const bool is_first = truth != nullptr && truth == answer.hypotheses.data();
      EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
                   answer.shape.curve_class == CurveClass::Unclassified)
          << name_of(curve_class) << " " << i << ": " << test::said(answer);
      ++all;
      first += is_first ? 1 : 0;
      if (!is_first)
        std::cout << "  " << name_of(curve_class) << " " << i << ": " << test::said(answer) << "\n";
    }
  }
  std::cout << "of " << all << " most probably what they are " << first << "\n";
  // What is asked of scenes whose class the data determine (bench_posterior), less four deviations
  // of so many scenes.
  const double missed = 0.08 * all;
  EXPECT_GE(first, all - missed - 4.0 * std::sqrt(missed));
}

TEST(StrokesToAndFro, OfFewSamplesAPassAreOfTheirClass) {
  expect_true_classes([](std::mt19937_64& rng) { return passes(3, 20, rng); });
}

TEST(StrokesToAndFro, ThatTrembleAtTheirEndAreOfTheirClass) {
  for (const double tremble : {0.02, 0.05, 0.1}) {
    expect_true_classes([&](std::mt19937_64& rng) { return trembling(60, 100, tremble, rng); });
  }
}

}  // namespace
}  // namespace palpate
