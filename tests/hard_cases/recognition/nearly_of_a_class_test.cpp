// Parts that are of a class but for a little: as soon as the samples show it, no class is certain.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/near_parts.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

// A misfit of 100 is chi-square raised by five of its standard deviations, of 200 samples. As a
// smooth deviation of known size and length it is worth 50 in log evidence, of which its prior
// leaves 15 and more: what bends a few times along the part costs at most as much as 25 (twice as
// many coordinates as a class has, a factor of ten each), one size and length of 27 costs 3, that
// such parts are rare 5.
TEST(NearlyOfAClass, IsNotRecognizedAsTheClassWhereItShows) {
  constexpr double kMisfit = 100.0;
  auto rng = test::test_rng();
  for (const test::NearPart& part : test::near_parts()) {
    const double sigma_m = test::noise_of_misfit(part, kMisfit);
    std::normal_distribution<double> normal;
    for (int i = 0; i < test::stress_count(40); ++i) {
      const Recognition answer =
          test::recognise(test::touched(part, sigma_m, [&] { return normal(rng); }), sigma_m);
      EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
                   answer.shape.curve_class != CurveClass::Unclassified)
          << part.name << " as " << name_of(answer.shape.curve_class);
    }
  }
}

// The same samples are of the class if the part has a tolerance as large.
TEST(NearlyOfAClass, IsOfTheClassWithinAStatedFormDeviation) {
  const test::NearPart lobed = test::near_parts().back();
  const double sigma_m = test::noise_of_misfit(lobed, 100.0);
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  RecognizerOptions options;
  options.form_deviation_m = 5e-5;  // its lobes
  for (int i = 0; i < test::stress_count(40); ++i) {
    const test::Scene scene = test::touched(lobed, sigma_m, [&] { return normal(rng); });
    const Recognition answer = test::recognise(scene, sigma_m, options);
    EXPECT_NE(answer.shape.curve_class, CurveClass::Unclassified);
    EXPECT_LT(test::hypothesis_of(answer, CurveClass::Unclassified)->probability, 0.05);
  }
}

/// NACA 0012 (NACA Report 460, equation 6), at even steps from the trailing edge round the nose.
std::vector<Vec2> aerofoil(double chord_m, double step_m) {
  std::vector<Vec2> places;
  for (double root = -0.98; root < 0.98; root += 1e-4) {  // of the share of the chord
    const double x = root * root;
    const double half = 0.6 * (0.2969 * std::abs(root) - 0.1260 * x - 0.3516 * x * x +
                               0.2843 * x * x * x - 0.1015 * x * x * x * x);
    const Vec2 place = chord_m * Vec2(x, std::copysign(half, root));
    if (places.empty() || (place - places.back()).norm() >= step_m) {
      places.push_back(place);
    }
  }
  return places;
}

// Of unstated noise: a spline fits with seven times the noise that the stroke shows. A probe may
// deviate so, but not by three thousandths of the part.
TEST(NearlyOfAClass, AnAerofoilOfUnstatedNoiseIsNoSpline) {
  auto rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, 2e-5);
  for (int scene = 0; scene < test::stress_count(20); ++scene) {
    std::vector<ContactSample> samples;
    for (const Vec2& place : aerofoil(0.1, 1e-3)) {
      ContactSample sample;
      const double x = noise(rng);
      sample.position_m = place + Vec2(x, noise(rng));
      samples.push_back(sample);
    }
    Recognizer recognizer;
    recognizer.add({}, samples);
    const Recognition answer = recognizer.recognize();
    EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
                 answer.shape.curve_class != CurveClass::Unclassified)
        << name_of(answer.shape.curve_class);
  }
}

}  // namespace
}  // namespace palpate
