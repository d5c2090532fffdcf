// Strokes along the long sides of thin ellipses, which cubics fit nearly as well.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/ellipse.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kA = 0.05;
constexpr int kSamples = 111;

/// Evenly along the upper side, from -reach to 0.9 reach of the half axis.
std::vector<Vec2> along_side(const Ellipse& ellipse, double reach) {
  const double begin = std::acos(-reach);
  const double length = ellipse.arc_length(begin, std::acos(0.9 * reach));
  std::vector<Vec2> places;
  for (int i = 0; i < kSamples; ++i) {
    places.push_back(
        ellipse.position(ellipse.parameter_at_arc_length(begin, length * i / (kSamples - 1))));
  }
  return places;
}

Recognition touched(const std::vector<Vec2>& places, double sigma_m, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  std::vector<ContactSample> samples;
  for (const Vec2& place : places) {
    samples.push_back({place + Vec2(noise(rng), noise(rng)), sigma_m, 0});
  }
  Recognizer recognizer;
  recognizer.add({}, samples);
  return recognizer.recognize();
}

TEST(FlatSides, OfEllipsesAreNoSplines) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(20);
  int wrong = 0;
  double stated_wrong = 0.0;
  int determined = 0;
  int determined_right = 0;
  for (const double ratio : {0.5, 0.2, 0.1, 0.05}) {
    const Ellipse ellipse{kA, ratio * kA};
    for (const double reach : {0.5, 0.8, 0.95, 0.995}) {
      const std::vector<Vec2> places = along_side(ellipse, reach);
      for (const double noise : {1e-5, 1e-4, 1e-3}) {
        // Up to the tips curvature changes by the third power of the ratio of the axes.
        const bool is_determined = reach > 0.9 && noise < 2e-5;
        int ellipses = 0;
        int others = 0;
        for (int i = 0; i < scenes; ++i) {
          const Recognition answer = touched(places, noise * reach * kA, rng);
          const bool recognized = answer.status == RecognitionStatus::Recognized;
          const bool right = recognized && answer.shape.curve_class == CurveClass::Ellipse;
          stated_wrong += recognized ? 1.0 - answer.hypotheses.front().probability : 0.0;
          ellipses += right ? 1 : 0;
          others += recognized && !right ? 1 : 0;
          determined += is_determined ? 1 : 0;
        }
        wrong += others;
        determined_right += is_determined ? ellipses : 0;
        std::cout << "b / a " << ratio << ", " << 100.0 * reach << " % of a side, noise " << noise
                  << ": of " << scenes << " RECOGNIZED " << ellipses << ", as another " << others
                  << "\n";
      }
    }
  }
  // Four deviations, and one where few are expected.
  EXPECT_LE(wrong, stated_wrong + 4.0 * std::sqrt(stated_wrong) + 1.0);
  // What is asked of scenes whose class the data determine (bench_posterior).
  EXPECT_GE(determined_right, 0.92 * determined);
}

}  // namespace
}  // namespace palpate
