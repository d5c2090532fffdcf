// The estimators by name, and along a patch.
#include "core/local/estimator.h"

#include <gtest/gtest.h>

#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

class EveryEstimator : public testing::TestWithParam<EstimatorKind> {};

INSTANTIATE_TEST_SUITE_P(AllEstimators, EveryEstimator,
                         testing::Values(EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                                         EstimatorKind::TwoRound, EstimatorKind::Jet));

TEST_P(EveryEstimator, AlongAPatchEachWindowStandsAlone) {
  constexpr std::size_t kSamples = 300;
  auto rng = test::test_rng();
  const std::vector<Vec2> samples =
      test::with_noise(test::samples_of(test::touched_arcs()[2], kSamples), 2e-5, rng);
  EstimatorOptions options;
  options.kind = GetParam();
  const std::size_t window = samples_per_estimate(options);
  const std::vector<WindowResult> along = estimate_all(samples, options);
  ASSERT_EQ(along.size(), (kSamples - window) / 4 + 1);
  for (std::size_t i = 0; i < along.size(); ++i) {
    ASSERT_EQ(along[i].first_sample, 4 * i);
    const LocalResult alone =
        estimate_window(std::span(samples).subspan(along[i].first_sample, window), options);
    EXPECT_EQ(along[i].result.status, alone.status);
    EXPECT_EQ(along[i].result.estimate.kappa, alone.estimate.kappa);
    EXPECT_EQ(along[i].result.estimate.kappa_s, alone.estimate.kappa_s);
    EXPECT_EQ(along[i].result.estimate.covariance, alone.estimate.covariance);
  }
  EXPECT_TRUE(estimate_all(std::span(samples).first(window - 1), options).empty());
}

TEST(Estimator, NamesReadBack) {
  for (const auto kind : {EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                          EstimatorKind::TwoRound, EstimatorKind::Jet}) {
    EXPECT_EQ(estimator_kind_from_name(name_of(kind)), kind);
  }
  EXPECT_FALSE(estimator_kind_from_name("spline").has_value());
}

TEST(Estimator, TwoRoundTakesThePapersSamples) {
  EstimatorOptions options;
  options.kind = EstimatorKind::TwoRound;
  EXPECT_EQ(samples_per_estimate(options), 111U);  // 75 + 9 * 4
}

}  // namespace
}  // namespace palpate
