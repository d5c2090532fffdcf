// Strokes of a round tip along the outside of a hyperbola, between its branches, by a tip that is
// larger than its a: near the vertex the centre is beyond the hyperbola's centre, next to the other
// branch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/hyperbola.h"
#include "core/curves/pose2.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct TouchedHyperbola {
  Hyperbola curve;
  Pose2 world_T_curve;
  double radius_m = 0.0;
  double sigma_m = 0.0;
};

TouchedHyperbola random_hyperbola(std::mt19937_64& rng) {
  TouchedHyperbola touched;
  touched.curve.a = test::log_uniform(rng, 0.004, 0.02);
  touched.curve.b = test::log_uniform(rng, 0.005, 0.03);
  touched.world_T_curve = {test::uniform(rng, -0.1, 0.1), test::uniform(rng, -0.1, 0.1),
                           test::uniform(rng, -kPi, kPi)};
  touched.radius_m = touched.curve.a * test::uniform(rng, 0.8, 3.0);
  touched.sigma_m = test::log_uniform(rng, 1e-6, 3e-5);
  return touched;
}

/// Three strokes that overlap, the middle one about the vertex.
Recognition recognised(const TouchedHyperbola& touched, std::mt19937_64& rng) {
  std::normal_distribution<double> normal(0.0, touched.sigma_m);
  RecognizerOptions options;
  options.touched_from = TouchedFrom::Outside;
  Recognizer recognizer(options);
  constexpr int kSamples = 80;
  for (std::uint32_t patch = 0; patch < 3; ++patch) {
    const double middle = -1.0 + 1.0 * patch + test::uniform(rng, -0.2, 0.2);
    const double half = test::random_sign(rng) * test::uniform(rng, 0.3, 0.6);
    std::vector<ContactSample> stroke;
    for (int i = 0; i < kSamples; ++i) {
      const double t = middle + half * (2.0 * i / (kSamples - 1) - 1.0);
      const CurveDerivatives at = touched.curve.derivatives(t);
      const Vec2 centre = at.position + touched.radius_m * left_of(at.first).normalized();
      stroke.push_back(
          {touched.world_T_curve * centre + Vec2(normal(rng), normal(rng)), touched.sigma_m, 0});
    }
    recognizer.add({0, patch, touched.radius_m}, stroke);
  }
  return recognizer.recognize();
}

/// Of theta and the vertex, in standard deviations, the larger.
double deviations_of_pose(const Recognition& answer, const TouchedHyperbola& touched) {
  const double turned =
      std::remainder(answer.world_T_curve.theta - touched.world_T_curve.theta, 2.0 * kPi);
  const double moved = std::hypot(answer.world_T_curve.x - touched.world_T_curve.x,
                                  answer.world_T_curve.y - touched.world_T_curve.y);
  return std::max(std::abs(turned) / std::sqrt(answer.covariance(4, 4)),
                  moved / std::sqrt(answer.covariance(2, 2) + answer.covariance(3, 3)));
}

TEST(TipsOnHyperbolas, LargerThanATheyTouchTheirOwnBranch) {
  const int scenes = test::stress_count(150);
  int recognized = 0;
  int wrong = 0;
  double expected_wrong = 0.0;
  for (int i = 0; i < scenes; ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 rng = test::seeded_rng(test::test_seed(), {static_cast<std::uint32_t>(i)});
    const TouchedHyperbola touched = random_hyperbola(rng);
    const Recognition answer = recognised(touched, rng);
    if (answer.status != RecognitionStatus::Recognized) {
      continue;
    }
    ++recognized;
    expected_wrong += 1.0 - answer.hypotheses.front().probability;
    if (answer.shape.curve_class != CurveClass::Hyperbola) {
      ++wrong;
      continue;
    }
    EXPECT_LT(deviations_of_pose(answer, touched), kNegligibleDeviations);
  }
  std::cout << "of " << scenes << ": RECOGNIZED " << recognized << ", wrong " << wrong << '\n';
  if (test::counts_tell()) {
    EXPECT_LE(wrong, test::most_of_poisson(expected_wrong));
    EXPECT_GT(2 * recognized, scenes);  // strokes over most of a branch determine it
  }
}

}  // namespace
}  // namespace palpate
