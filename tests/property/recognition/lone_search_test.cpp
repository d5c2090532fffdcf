// Single touches in no order: the search must find the optimum of each class.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <span>

#include "tests/support/lone_touches.h"
#include "tests/support/search_outcome.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Chi-square above the optimum by which the true class would be excluded: odds of 1000.
const double kDecisive = 2.0 * std::log(1000.0);

/// One arm of a semi-cubical parabola, starting next to its cusp. A vertex in the middle of the
/// touches must not leave those before it free: with such a solution the class was worse by 4000 of
/// chi-square.
TEST(LoneSearch, FindsOneArmOfASemiCubicalParabolaBesideItsCusp) {
  constexpr double kA = 4.0;  // 1/sqrt m
  constexpr double kB = 0.3;
  constexpr double kFrom = 0.06;  // sqrt m
  constexpr double kTo = 0.2;
  constexpr double kSigma_m = 1e-4;
  constexpr int kTouches = 11;
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kSigma_m);
  const int scenes = test::stress_count(60);
  for (int i = 0; i < scenes; ++i) {
    test::SearchCase scene;
    scene.scene.curve_class = CurveClass::SemiCubicalParabola;
    scene.scene.values = {kA, kB, 0.0};
    scene.scene.world_T_curve = {test::uniform(rng, -0.5, 0.5), test::uniform(rng, -0.5, 0.5),
                                 test::uniform(rng, -kPi, kPi)};
    scene.scene.sigma_m = kSigma_m;
    for (int k = 0; k < kTouches; ++k) {
      const double t = test::uniform(rng, kFrom, kTo);
      Vec2 place = scene.scene.world_T_curve * Vec2(t * t, kA * t * t * t + kB * t * t);
      const double y = noise(rng);
      place += Vec2(noise(rng), y);
      scene.scene.patches.push_back({place});
      scene.scene.t.push_back({t});
    }
    const test::SearchOutcome outcome = test::outcome_on_reduced(scene);
    ASSERT_TRUE(outcome.counted) << i;
    EXPECT_LT(outcome.excess(), kDecisive) << i;
  }
}

/// The search through splines' touches may miss the deepest valley in one of a hundred scenes.
void expect_splines_found(double sigma_over_size, std::span<const int> counts, int scenes) {
  constexpr double kMissed = 0.01;
  constexpr double kNoTip = 0.0;
  std::mt19937_64 rng = test::test_rng();
  int counted = 0;
  int missed = 0;
  for (int i = 0; i < scenes; ++i) {
    for (const int count : counts) {
      test::SearchCase scene;
      scene.scene =
          test::lone_touches(CurveClass::CubicSpline, count, sigma_over_size, kNoTip, rng).scene;
      const test::SearchOutcome outcome = test::outcome_on_reduced(scene);
      counted += outcome.counted ? 1 : 0;
      missed += outcome.counted && outcome.excess() > kDecisive ? 1 : 0;
    }
  }
  std::printf("missed %d of %d\n", missed, counted);
  EXPECT_GT(counted, (static_cast<int>(counts.size()) - 1) * scenes);
  const double expected = kMissed * counted;  // plus three deviations of such a count
  EXPECT_LE(missed, expected + 3.0 * std::sqrt(expected));
}

/// Of few touches any may lie on either arm, and each pattern of arms has valleys of its own.
TEST(LoneSearch, FindsSplinesThroughFewTouches) {
  expect_splines_found(1e-4, std::array{8, 10, 12, 16, 24}, test::stress_count(300));
}

/// Where noise is not much less than the arms are apart, the deepest valley is not the one in which
/// a walk by distances across the axis ends lowest.
TEST(LoneSearch, FindsSplinesThroughNoisyTouches) {
  expect_splines_found(4e-3, std::array{16, 20, 24, 28}, test::stress_count(300));
}

}  // namespace
}  // namespace palpate
