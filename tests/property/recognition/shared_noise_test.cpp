// Probes that are read faster than their noise changes: neighbours err together. What is stated is
// the noise of a sample, or nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>
#include <tuple>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "tests/support/calibration.h"
#include "tests/support/expect_calibrated.h"
#include "tests/support/joint_error.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/scene_data.h"
#include "tests/support/shared_noise.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Of a bin of answers; six cases have three bins each.
constexpr double kCoverage = 0.9999;

struct Tally {
  int recognized = 0;
  int wrong = 0;   ///< RECOGNIZED, of another class or of none
  int none = 0;    ///< of these, of none
  int beyond = 0;  ///< of those that are right, with the truth beyond the 95 % ellipsoid
  test::Calibration calibration;

  void count(const Recognition& answer, const test::Scene& scene) {
    const CurveClass said = answer.hypotheses.front().shape.curve_class;
    calibration.add(answer.hypotheses.front().probability, said == scene.curve_class);
    if (answer.status != RecognitionStatus::Recognized) {
      return;
    }
    ++recognized;
    if (said != scene.curve_class) {
      ++wrong;
      none += said == CurveClass::Unclassified ? 1 : 0;
      return;
    }
    const test::JointError error = test::joint_error(answer.hypotheses.front(), scene);
    const auto unknowns = static_cast<int>(error.error.size());
    beyond += test::squared_distance(error) > chi_square_threshold(0.05, unknowns) ? 1 : 0;
  }
};

/// Scenes of classes with noise of which neighbours share so much, and beside them the same scenes
/// with white noise that tells as little.
struct Beside {
  Tally shared;
  Tally white;
};

Beside tally_of(double correlation, bool stated) {
  Beside tally;
  const double factor = std::sqrt(test::time_of_shared_noise(correlation));
  const int scenes = test::stress_count(400);
  for (int i = 0; i < scenes; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    test::PriorScene drawn =
        test::scene_from(test::classes_only(test::even_prior()), test::test_seed(), number);
    std::mt19937_64 rng = test::test_rng(number);
    const test::Scene shared = test::with_shared_noise(drawn, correlation, rng);
    tally.shared.count(test::recognise(shared, stated ? shared.sigma_m : 0.0), shared);
    drawn.scene.sigma_m *= factor;
    const test::Scene white = test::with_shared_noise(drawn, 0.0, rng);
    tally.white.count(test::recognise(white, stated ? white.sigma_m : 0.0), white);
  }
  std::cout << "  correlation " << correlation << (stated ? ", stated" : ", not stated")
            << ": RECOGNIZED " << tally.shared.recognized << " of " << scenes << ", wrong "
            << tally.shared.wrong << ", of none " << tally.shared.none << "; with white noise "
            << tally.white.recognized << "; beyond the 95 % ellipsoid " << tally.shared.beyond
            << "\n";
  return tally;
}

class SharedNoiseOf : public ::testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(SharedNoiseOf, IsCountedAsNoise) {
  const auto [correlation, stated] = GetParam();
  const Beside tally = tally_of(correlation, stated);
  if (!test::counts_tell()) {
    return;
  }
  // What neighbours share costs information, as much as white noise that much larger. Of white
  // noise nobody has to find out how much they share: a seventh fewer may be RECOGNIZED.
  EXPECT_GE(7 * tally.shared.recognized, 6 * tally.white.recognized);
  test::expect_calibrated(tally.shared.calibration,
                          "correlation " + std::to_string(correlation) + ",", 0.95, kCoverage);
  // RECOGNIZED leaves at most 1 in 20 to doubt.
  EXPECT_LE(20 * tally.shared.wrong, tally.shared.recognized);
  EXPECT_LE(tally.shared.beyond, test::most_of_poisson(0.05 * tally.shared.recognized));
}

/// Three strokes of 110 samples, of 1.6 rad each, round an ellipse.
test::PriorScene nearly_round(double a, double b, std::mt19937_64& rng) {
  test::PriorScene drawn;
  drawn.scene.curve_class = CurveClass::Ellipse;
  drawn.scene.values << a, b, 0.0;
  const double from = test::uniform(rng, 0.0, 2.0 * kPi);
  for (int stroke = 0; stroke < 3; ++stroke) {
    std::vector<Vec2> places;
    for (int i = 0; i < 110; ++i) {
      const double t = from + 2.0 * stroke + 1.6 * i / 109.0;
      places.emplace_back(a * std::cos(t), b * std::sin(t));
    }
    drawn.exact_patches.push_back(places);
  }
  drawn.scene.patches = drawn.exact_patches;
  return drawn;
}

// A stated noise is all by which a probe errs. Where neighbours err together, a circle touched with
// lobes of ten times that is no answer, nor a part near a circle.
TEST(SharedNoise, ANearlyRoundEllipseIsNoCircle) {
  constexpr double kB = 0.05;
  constexpr double kDifference = 2.5e-4;
  for (int i = 0; i < test::stress_count(60); ++i) {
    std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(i));
    test::PriorScene drawn = nearly_round(kB + kDifference, kB, rng);
    drawn.scene.sigma_m = 0.1 * kDifference;
    const test::Scene scene = test::with_shared_noise(drawn, 0.3, rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    EXPECT_EQ(answer.hypotheses.front().shape.curve_class, CurveClass::Ellipse) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SharedNoiseOf,
                         ::testing::Combine(::testing::Values(0.3, 0.5, 0.8), ::testing::Bool()));

}  // namespace
}  // namespace palpate
