// Checks the jet estimator's reported covariance against 2,000 trials with Gaussian noise on every
// class.
#include <gtest/gtest.h>

#include <cmath>

#include "core/local/jet_estimator.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

const int kTrials = test::stress_count(2000);
constexpr double kSigma = 5e-5;

/// The standard deviation of a standard deviation from 2,000 Gaussian trials is 1.6 %. To second
/// order, the noise along the abscissa adds up to about 5 % at the ends of a window.
constexpr double kTolerance = 0.15;

struct Case {
  std::size_t arc;
  int degree;
  double place;
};

class JetCovariance : public testing::TestWithParam<Case> {};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (std::size_t arc = 0; arc < test::touched_arcs().size(); ++arc) {
    all.push_back({arc, 3, 0.0});
    all.push_back({arc, 4, 0.0});
    all.push_back({arc, 5, 0.0});
    all.push_back({arc, 5, -0.9});
    all.push_back({arc, 5, 0.9});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(
    AllClasses, JetCovariance, testing::ValuesIn(cases()), [](const auto& param_info) {
      const Case& c = param_info.param;
      const std::string place = c.place < 0 ? "start" : c.place > 0 ? "end" : "centre";
      return test::touched_arcs()[c.arc].name + "_degree_" + std::to_string(c.degree) + "_" + place;
    });

TEST_P(JetCovariance, IsTrue) {
  const auto& [arc_index, degree, place] = GetParam();
  const test::TouchedArc& arc = test::touched_arcs()[arc_index];
  const JetOptions options{.degree = degree, .sigma_m = kSigma, .place = place};
  const std::vector<Vec2> exact = test::samples_of(arc, 111);
  const LocalResult noiseless = jet_estimate(exact, options);
  ASSERT_EQ(noiseless.status, LocalStatus::Ok);
  const Eigen::Matrix4d reported = noiseless.estimate.covariance;
  const Eigen::Vector4d sd = reported.diagonal().cwiseSqrt();

  auto rng = test::test_rng();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  for (int i = 0; i < kTrials; ++i) {
    const LocalResult result = jet_estimate(test::with_noise(exact, kSigma, rng), options);
    ASSERT_EQ(result.status, LocalStatus::Ok);
    const Eigen::Vector4d error = test::error_of(result.estimate, arc).cwiseQuotient(sd);
    sum += error;
    squares += error * error.transpose();
  }
  if (!test::counts_tell()) return;
  const Eigen::Vector4d mean = sum / kTrials;
  const Eigen::Matrix4d measured = squares / kTrials - mean * mean.transpose();
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::sqrt(measured(i, i)), 1.0, kTolerance) << i;
    for (int j = 0; j < i; ++j) {
      EXPECT_NEAR(measured(i, j), reported(i, j) / (sd[i] * sd[j]), kTolerance) << i << j;
    }
  }
  // Noise adds little bias: the mean equals the noiseless estimate within 5 standard deviations of
  // a mean of 2,000 (0.11) plus 1 % of the bias, which moves with the ends of the window. Noise
  // along the abscissa shifts the coefficient of P_k by (sigma / h) slope sqrt((2 k + 1) n) of its
  // standard deviation (jet_estimator.h; slope at most 0.6). Near an end the three coefficients
  // that kappa_s consists of add up, against sqrt(3) for their standard deviations.
  const double second_order =
      place == 0.0 ? 0.0 : 2.0 * (kSigma / 0.011) * 0.6 * std::sqrt(11 * 111);
  const Eigen::Vector4d bias = test::error_of(noiseless.estimate, arc).cwiseQuotient(sd);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(mean[i], bias[i], 0.11 + 0.01 * std::abs(bias[i]) + second_order) << i;
  }
}

}  // namespace
}  // namespace palpate
