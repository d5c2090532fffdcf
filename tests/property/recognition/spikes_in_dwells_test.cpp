// Spikes while the probe stands still, at both ends of its strokes: a mean of all readings would be
// off by a share of them, and the weight of all makes that certain.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/joint_error.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigma = 2e-5;  // [m]

/// Readings of one place, of which some are spikes, all to one side of the travel.
void add_rest(const Vec2& place, const Vec2& travel, int readings, double spikes,
              std::vector<Vec2>* samples, std::mt19937_64& rng) {
  const Vec2 aside = left_of(travel.normalized());
  for (int i = 0; i < readings; ++i) {
    Vec2 at = place + test::normal_pair(rng, kSigma);
    if (test::uniform(rng, 0.0, 1.0) < spikes) {
      at += kSigma * test::uniform(rng, 6.0, 40.0) * aside;
    }
    samples->push_back(at);
  }
}

Recognition stroked(const test::Scene& exact, double spikes, std::mt19937_64& rng) {
  constexpr int kReadings = 30;
  constexpr std::size_t kEvery = 10;
  test::Scene scene;
  for (const std::vector<Vec2>& way : exact.patches) {
    std::vector<Vec2>& samples = scene.patches.emplace_back();
    add_rest(way.front(), way[1] - way[0], kReadings, spikes, &samples, rng);
    for (std::size_t i = 0; i < way.size(); i += kEvery) {
      samples.push_back(way[i] + test::normal_pair(rng, kSigma));
    }
    add_rest(way.back(), way.back() - way[way.size() - 2], kReadings, spikes, &samples, rng);
  }
  return test::recognise(scene, kSigma);
}

TEST(SpikesInDwells, AreNotOfThePlace) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.patches = 3;
  options.points_per_patch = 600;
  options.sigma_over_size = 1e-9;
  options.size_m = 0.025;
  options.least_fraction = 0.15;
  const int scenes = test::stress_count(30);
  int all = 0;
  int first = 0;
  double squares = 0.0;
  double dof = 0.0;
  for (const CurveClass curve_class :
       {CurveClass::Line, CurveClass::Circle, CurveClass::Ellipse, CurveClass::Parabola}) {
    for (int i = 0; i < scenes; ++i) {
      const test::Scene exact = test::random_scene(curve_class, options, rng);
      const Recognition answer = stroked(exact, 0.05, rng);
      const Hypothesis* truth = test::hypothesis_of(answer, curve_class);
      ++all;
      if (truth == nullptr || truth != answer.hypotheses.data()) {
        continue;
      }
      ++first;
      if (answer.status == RecognitionStatus::Recognized) {
        const test::JointError error = test::joint_error(*truth, exact);
        squares += test::squared_distance(error);
        dof += static_cast<double>(error.error.size());
      }
    }
  }
  std::cout << "of " << all << " most probably what they are " << first
            << "; squared distance of the truth over its mean " << squares / dof << "\n";
  // What is asked of scenes whose class the data determine (bench_posterior), less four deviations
  // of so many scenes.
  const double missed = 0.08 * all;
  EXPECT_GE(first, all - missed - 4.0 * std::sqrt(missed));
  // The variance of chi-square is twice its mean.
  EXPECT_LE(squares, dof + 4.0 * std::sqrt(2.0 * dof));
}

}  // namespace
}  // namespace palpate
