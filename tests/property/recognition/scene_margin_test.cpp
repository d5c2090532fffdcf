// Tests of the test support itself: the scenes, margins and confidence bands that calibration tests
// rely on.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/calibration.h"
#include "tests/support/class_margin.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr int kScenes = 40;

TEST(ScenePrior, TheExactPointsAreThoseOfTheSceneWithoutItsNoise) {
  for (std::uint32_t i = 0; i < kScenes; ++i) {
    const test::PriorScene drawn = test::scene_from(test::even_prior(), test::test_seed(), i);
    double squares = 0.0;
    int count = 0;
    for (std::size_t p = 0; p < drawn.exact_patches.size(); ++p) {
      for (std::size_t k = 0; k < drawn.exact_patches[p].size(); ++k) {
        squares += (drawn.scene.patches[p][k] - drawn.exact_patches[p][k]).squaredNorm();
        count += 2;
      }
    }
    // The relative standard deviation of such a sum of squares is sqrt(2 / count) <= 0.1.
    EXPECT_NEAR(squares / count / std::pow(drawn.scene.sigma_m, 2), 1.0, 0.5) << i;
  }
}

TEST(ScenePrior, ASceneIsTheSameAloneAsAmongOthers) {
  const test::PriorScene once = test::scene_from(test::even_prior(), 7, 5);
  test::scene_from(test::even_prior(), 7, 4);
  const test::PriorScene again = test::scene_from(test::even_prior(), 7, 5);
  ASSERT_EQ(once.scene.patches.size(), again.scene.patches.size());
  EXPECT_EQ(once.scene.patches[0], again.scene.patches[0]);
}

TEST(GeometricFit, FindsTheTruthFromNearIt) {
  for (std::uint32_t i = 0; i < kScenes; ++i) {
    const test::PriorScene drawn =
        test::scene_from(test::classes_only(test::even_prior()), test::test_seed(), i);
    test::PlacedShape start{drawn.scene.curve_class, drawn.scene.values, drawn.scene.world_T_curve};
    EXPECT_LT(test::least_chi2(drawn, {&start, 1}), 1e-6) << i << " from the truth itself";
    // A hundredth of a per cent off the truth: closer than the basin of a neighbouring optimum.
    start.values *= 1.0001;
    start.world_T_curve.x += 1e-4 * drawn.size_m;
    start.world_T_curve.theta += 1e-4;
    EXPECT_LT(test::least_chi2(drawn, {&start, 1}), 0.1) << i << " from beside it";
  }
}

TEST(ClassMargin, OccamFactorsGrowAsTheNoiseFalls) {
  int compared = 0;
  for (std::uint32_t i = 0; i < kScenes; ++i) {
    test::PriorScene drawn =
        test::scene_from(test::classes_only(test::even_prior()), test::test_seed(), i);
    const double factor = test::occam_against_richer(drawn);
    drawn.scene.sigma_m *= 0.01;
    const double finer = test::occam_against_richer(drawn);
    if (!std::isfinite(factor) || factor < 3.0) {
      continue;
    }
    ++compared;
    // A parameter's standard deviation is proportional to the noise, or to its square root if
    // chi-square grows with the fourth power. A circle has two such parameters.
    const CurveClass truth = drawn.scene.curve_class;
    const double power = truth == CurveClass::SemiCubicalParabola ? 0.5 : 1.0;
    EXPECT_GT(finer, 0.8 * factor * std::pow(100.0, power)) << i;
    EXPECT_LT(finer, 1.2 * factor * std::pow(100.0, truth == CurveClass::Circle ? 2.0 : power))
        << i;
  }
  EXPECT_GT(compared, 5);
}

TEST(BinomialBand, HoldsAllButTheTailsOfTheExactLaw) {
  // For 20 tosses of a coin: P(at most 2) = 2.0e-4, P(at most 3) = 1.3e-3.
  const test::Band coin = test::binomial_band(std::vector<double>(20, 0.5), 0.999);
  EXPECT_EQ(coin.least, 3);
  EXPECT_EQ(coin.most, 17);
  // For 100 trials at 0.999: P(at most 97) = 1.5e-4, P(at most 98) = 4.6e-3.
  const test::Band sure = test::binomial_band(std::vector<double>(100, 0.999), 0.999);
  EXPECT_EQ(sure.least, 98);
  EXPECT_EQ(sure.most, 100);
  EXPECT_EQ(test::binomial_band(std::vector<double>(3, 0.5), 0.999).least, 0);
}

}  // namespace
}  // namespace palpate
