// Checks every estimator's reported standard deviations against 2,000 trials with Gaussian noise on
// every class, and the jet's accuracy against the two-round fit's over the same samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/local/estimator.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

const int kTrials = test::stress_count(2000);
constexpr int kSamples = 111;  // the paper's 75 + 9 * 4
constexpr double kSigma = 5e-5;

/// A standard deviation from n Gaussian trials has the relative standard deviation 1 / sqrt(2 n),
/// 1.6 % for 2,000. Over the 128 comparisons (estimator, class, component), five of these are
/// exceeded by chance once in 14,000 runs.
const double kTolerance = 5.0 / std::sqrt(2.0 * kTrials);

struct Statistics {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Eigen::Vector4d sd = Eigen::Vector4d::Zero();
  Eigen::Vector4d rmse = Eigen::Vector4d::Zero();
  Eigen::Vector4d reported_sd = Eigen::Vector4d::Zero();  ///< root mean reported variance
};

EstimatorOptions options_for(EstimatorKind kind) {
  EstimatorOptions options;
  options.kind = kind;
  options.sigma_m = kSigma;
  options.window = kind == EstimatorKind::TwoRound ? 75 : kSamples;
  return options;
}

Statistics trials(const test::TouchedArc& arc, const EstimatorOptions& options) {
  const std::vector<Vec2> exact = test::samples_of(arc, kSamples);
  auto rng = test::test_rng();
  Statistics s;
  for (int i = 0; i < kTrials; ++i) {
    const LocalResult result = estimate_window(test::with_noise(exact, kSigma, rng), options);
    EXPECT_EQ(result.status, LocalStatus::Ok);
    const Eigen::Vector4d error = test::error_of(result.estimate, arc);
    s.mean += error / kTrials;
    s.rmse += error.cwiseAbs2() / kTrials;
    s.reported_sd += result.estimate.covariance.diagonal() / kTrials;
  }
  s.sd = (s.rmse - s.mean.cwiseAbs2()).cwiseSqrt();
  s.rmse = s.rmse.cwiseSqrt();
  s.reported_sd = s.reported_sd.cwiseSqrt();
  return s;
}

class EstimatorCovariance : public testing::TestWithParam<std::tuple<EstimatorKind, std::size_t>> {
};

INSTANTIATE_TEST_SUITE_P(
    AllClasses, EstimatorCovariance,
    testing::Combine(testing::Values(EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                                     EstimatorKind::TwoRound, EstimatorKind::Jet),
                     testing::Range(std::size_t{0}, test::touched_arcs().size())),
    [](const auto& param_info) {
      std::string name = std::string(name_of(std::get<0>(param_info.param))) + "_" +
                         test::touched_arcs()[std::get<1>(param_info.param)].name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST_P(EstimatorCovariance, IsTrue) {
  const auto [kind, index] = GetParam();
  const test::TouchedArc& arc = test::touched_arcs()[index];
  const Statistics s = trials(arc, options_for(kind));
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(s.sd[i] / s.reported_sd[i], 1.0, kTolerance) << i;
  }
  // Bias in standard deviations, for the record; core/README.md has the table.
  RecordProperty("bias_kappa_sd", std::to_string(s.mean[2] / s.reported_sd[2]));
  RecordProperty("bias_kappa_s_sd", std::to_string(s.mean[3] / s.reported_sd[3]));
}

// Which of jet and two-round fit is better follows from the reported covariance of each and its
// bias, which is its error on samples without noise.
TEST(JetAgainstTwoRound, ErrorsAreTheReportedNoiseAndTheBiasOfTheCurve) {
  for (const test::TouchedArc& arc : test::touched_arcs()) {
    const std::vector<Vec2> exact = test::samples_of(arc, kSamples);
    std::printf("%-22s", arc.name.c_str());
    for (const EstimatorKind kind : {EstimatorKind::Jet, EstimatorKind::TwoRound}) {
      const Statistics s = trials(arc, options_for(kind));
      const LocalResult without_noise = estimate_window(exact, options_for(kind));
      ASSERT_EQ(without_noise.status, LocalStatus::Ok);
      const Eigen::Vector4d bias = test::error_of(without_noise.estimate, arc);
      std::printf("  %s: kappa %.2f, kappa_s %.0f", std::string(name_of(kind)).c_str(), s.rmse[2],
                  s.rmse[3]);
      for (const Eigen::Index i : {2, 3}) {
        const double expected = std::hypot(s.reported_sd[i], bias[i]);
        EXPECT_NEAR(s.rmse[i] / expected, 1.0, kTolerance) << arc.name << " component " << i;
      }
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace palpate
