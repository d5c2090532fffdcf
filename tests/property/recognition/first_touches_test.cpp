// The first samples of an object: few samples on short patches, whose estimated curvature is mostly
// noise.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>

#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr int kScenes = 60;  // for each class and number of samples

/// Log-uniform between the bounds.
double between(double least, double most, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> law(std::log(least), std::log(most));
  return std::exp(law(rng));
}

class FirstTouches : public testing::TestWithParam<CurveClass> {};

TEST_P(FirstTouches, DoNotExcludeEveryClass) {
  // The method's claim about the fraction of wrong RECOGNIZED answers, and how far a count may be
  // above it with probability 1e-3.
  constexpr double kClaimed = 0.005;
  constexpr double kDeviations = 3.1;
  std::mt19937_64 rng = test::test_rng();
  int answers = 0;
  int none = 0;
  int other = 0;
  for (const int samples : {4, 5, 8, 12, 20}) {
    for (int i = 0; i < test::stress_count(kScenes); ++i) {
      test::SceneOptions options;
      options.patches = 2 + i % 2;
      options.points_per_patch = samples;
      options.least_arc_over_size = options.most_arc_over_size = between(0.01, 0.1, rng);
      options.sigma_over_size = between(1e-4, 2e-3, rng);
      const test::Scene scene = test::random_scene(GetParam(), options, rng);
      const Recognition answer = test::recognise(scene, scene.sigma_m);
      const bool recognised = answer.status == RecognitionStatus::Recognized;
      const CurveClass named = answer.shape.curve_class;
      ++answers;
      none += recognised && named == CurveClass::Unclassified ? 1 : 0;
      other += recognised && named != CurveClass::Unclassified && named != GetParam() ? 1 : 0;
    }
  }
  std::cout << "  " << name_of(GetParam()) << ": of " << answers << " answers " << none
            << " surely of no class, " << other << " surely of another\n";
  const double spread = std::sqrt(answers * kClaimed * (1.0 - kClaimed));
  EXPECT_LE(none, kClaimed * answers + kDeviations * spread);
}

INSTANTIATE_TEST_SUITE_P(AllClasses, FirstTouches, testing::ValuesIn(kCurveClasses),
                         [](const auto& param_info) {
                           return std::string(name_of(param_info.param));
                         });

}  // namespace
}  // namespace palpate
