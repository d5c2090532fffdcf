// The adaptive jet: honest about bias and noise together, and more accurate than a fixed window.
#include "core/local/adaptive_jet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/local/estimator.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

constexpr int kTrials = 500;
constexpr int kSamples = 111;

struct Accuracy {
  Eigen::Vector4d rmse = Eigen::Vector4d::Zero();
  Eigen::Vector4d normalised = Eigen::Vector4d::Zero();  ///< rms of error / reported sd
};

template <typename Estimate>
Accuracy measure(const test::TouchedArc& arc, double sigma_m, Estimate&& estimate) {
  const std::vector<Vec2> exact = test::samples_of(arc, kSamples);
  auto rng = test::test_rng();
  Accuracy a;
  for (int i = 0; i < kTrials; ++i) {
    const LocalResult result = estimate(test::with_noise(exact, sigma_m, rng));
    EXPECT_EQ(result.status, LocalStatus::Ok);
    const Eigen::Vector4d square = test::error_of(result.estimate, arc).cwiseAbs2();
    a.rmse += square / kTrials;
    a.normalised += square.cwiseQuotient(result.estimate.covariance.diagonal()) / kTrials;
  }
  a.rmse = a.rmse.cwiseSqrt();
  a.normalised = a.normalised.cwiseSqrt();
  return a;
}

class AdaptiveJetOf : public testing::TestWithParam<std::size_t> {
 protected:
  const test::TouchedArc& arc() const { return test::touched_arcs()[GetParam()]; }
};

INSTANTIATE_TEST_SUITE_P(AllClasses, AdaptiveJetOf,
                         testing::Range(std::size_t{0}, test::touched_arcs().size()),
                         [](const auto& param_info) {
                           return test::touched_arcs()[param_info.param].name;
                         });

TEST_P(AdaptiveJetOf, CoversItsErrorsBiasIncluded) {
  for (const double sigma : {1e-5, 5e-5, 2e-4}) {
    for (const PatchPlace place : {PatchPlace::Start, PatchPlace::Centre, PatchPlace::End}) {
      const Accuracy a = measure(arc(), sigma, [&](std::span<const Vec2> samples) {
        return adaptive_jet(samples, place, sigma).result;
      });
      // The prior is one for all curves, so that a class is over- or understated; the bounds are
      // twice the noise-only ideal of 1 in the middle, and four times at an end, where all is
      // extrapolated (the plain jet of degree 3 or 4 is off by up to 200 there).
      const double most = place == PatchPlace::Centre ? 2.0 : 4.0;
      for (int i = 0; i < 4; ++i) {
        EXPECT_LT(a.normalised[i], most) << sigma << " " << static_cast<int>(place) << " " << i;
      }
    }
  }
}

TEST_P(AdaptiveJetOf, KappaIsAtLeastAsAccurateAsTheTwoRoundFits) {
  for (const double sigma : {1e-5, 5e-5, 2e-4}) {
    const Accuracy adaptive = measure(arc(), sigma, [&](std::span<const Vec2> samples) {
      return adaptive_jet(samples, PatchPlace::Centre, sigma).result;
    });
    EstimatorOptions options;
    options.kind = EstimatorKind::TwoRound;
    options.sigma_m = sigma;
    const std::vector<Vec2> exact = test::samples_of(arc(), kSamples);
    auto rng = test::test_rng();
    double square = 0.0;
    double square_s = 0.0;
    int count = 0;
    for (int i = 0; i < kTrials; ++i) {
      const LocalResult result = estimate_window(test::with_noise(exact, sigma, rng), options);
      if (result) {
        const Eigen::Vector4d error = test::error_of(result.estimate, arc());
        square += error[2] * error[2];
        square_s += error[3] * error[3];
        ++count;
      }
    }
    ASSERT_GT(count, kTrials / 2);
    const double two_round = std::sqrt(square / count);
    std::printf("%-22s sigma %.0e kappa %.3g / %.3g  kappa_s %.3g / %.3g\n", arc().name.c_str(),
                sigma, adaptive.rmse[2], two_round, adaptive.rmse[3], std::sqrt(square_s / count));
    // The ratio of two correlated errors from 500 trials is known to 5 %. At 0.2 mm, where nothing
    // but its prior holds the quartic term, the ellipse is 9 % worse (core/README.md).
    EXPECT_LT(adaptive.rmse[2], (sigma < 1e-4 ? 1.05 : 1.15) * two_round) << sigma;
  }
}

TEST_P(AdaptiveJetOf, ExactSamplesGiveExactGeometry) {
  const std::vector<Vec2> exact = test::samples_of(arc(), kSamples);
  for (const AdaptiveJet& jet : patch_estimates(exact)) {
    ASSERT_EQ(jet.result.status, LocalStatus::Ok);
    const Eigen::Vector4d error = test::error_of(jet.result.estimate, arc());
    // Dimensionless in 22 mm: what the ninth-degree terms leave at a window's end.
    EXPECT_LT(std::abs(error[0]) / 0.022, 1e-7);
    EXPECT_LT(std::abs(error[1]), 1e-5);
    EXPECT_LT(std::abs(error[2]) * 0.022, 1e-3);
    EXPECT_LT(std::abs(error[3]) * 0.022 * 0.022, 5e-2);
  }
}

TEST(AdaptiveJet, ShortensAWindowThatTurnsTooFar) {
  test::TouchedArc arc = test::touched_arcs()[1];
  arc.length_m = 1.5 * kPi * 0.020;
  const std::vector<Vec2> samples = test::samples_of(arc, 200);
  const AdaptiveJet jet = adaptive_jet(samples, PatchPlace::Start, 2e-5);
  ASSERT_EQ(jet.result.status, LocalStatus::Ok);
  EXPECT_EQ(jet.first_sample, 0U);
  // A third of the 270 degrees is the longest that stays within 45 degrees of its axis.
  EXPECT_LE(jet.samples, 68U);
  EXPECT_GE(jet.samples, 40U);
}

TEST(AdaptiveJet, ShortPatches) {
  const std::vector<Vec2> samples = test::samples_of(test::touched_arcs()[2], 17);
  EXPECT_EQ(adaptive_jet(samples, PatchPlace::Centre, 2e-5).result.status, LocalStatus::Ok);
  EXPECT_EQ(adaptive_jet({}, PatchPlace::Centre).result.status, LocalStatus::TooFewSamples);
  EXPECT_EQ(adaptive_jet(std::vector<Vec2>(50, Vec2(1, 2)), PatchPlace::End).result.status,
            LocalStatus::NoExtent);
}

TEST(AdaptiveJet, AllocatesNothingWithTheNoiseGiven) {
  const std::vector<Vec2> samples = test::samples_of(test::touched_arcs()[2], 111);
  const std::size_t before = test::allocation_count();
  const AdaptiveJet jet = adaptive_jet(samples, PatchPlace::Centre, 2e-5);
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(jet.result.status, LocalStatus::Ok);
}

}  // namespace
}  // namespace palpate
