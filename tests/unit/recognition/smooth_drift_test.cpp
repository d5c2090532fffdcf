// The recursion against the normal law that it is: white rows and their determinant.
#include "core/recognition/coherent/smooth_drift.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr int kColumns = 3;

/// Covariance of noise and drift; places of different runs share nothing.
Eigen::MatrixXd covariance_of(const std::vector<DriftStep>& steps, const Drift& drift) {
  const auto n = static_cast<Eigen::Index>(steps.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    covariance(i, i) += steps[static_cast<std::size_t>(i)].variance;
    double distance = 0.0;
    for (Eigen::Index j = i; j >= 0 && std::isfinite(distance); --j) {
      const double a = std::sqrt(3.0) * distance / drift.length;
      const double shared = drift.deviation * drift.deviation * (1.0 + a) * std::exp(-a);
      covariance(i, j) += shared;
      covariance(j, i) = covariance(i, j);
      distance += steps[static_cast<std::size_t>(j)].from_last;
    }
  }
  return covariance;
}

TEST(SmoothDrift, IsTheNormalLawOfItsCovariance) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  for (const Drift& drift : {Drift{0.0, 1.0}, Drift{0.3, 0.5}, Drift{20.0, 0.2}, Drift{5.0, 3.0}}) {
    std::vector<DriftStep> steps;
    Eigen::MatrixXd rows(40, kColumns);
    for (int i = 0; i < 40; ++i) {
      DriftStep step;
      step.variance = test::log_uniform(rng, 0.01, 1.0);
      step.from_last =
          i % 15 == 0 ? std::numeric_limits<double>::infinity() : test::log_uniform(rng, 0.01, 0.3);
      steps.push_back(step);
      for (int k = 0; k < kColumns; ++k) rows(i, k) = normal(rng);
    }
    const Eigen::LLT<Eigen::MatrixXd> root(covariance_of(steps, drift));
    const Eigen::MatrixXd white = root.matrixL().solve(rows);
    double log_determinant = 0.0;
    SmoothDriftFilter<kColumns> filter(drift);
    for (int i = 0; i < 40; ++i) {
      const auto next = filter.next(steps[static_cast<std::size_t>(i)], rows.row(i));
      log_determinant += 0.5 * std::log(next.variance);
      // Digits lost to the condition of the covariance, 20^2 over the least noise of 0.01.
      EXPECT_LT((next.row - white.row(i)).norm(), 1e-10 * (1.0 + white.row(i).norm())) << i;
    }
    EXPECT_NEAR(log_determinant, root.matrixLLT().diagonal().array().log().sum(), 1e-10);
  }
}

}  // namespace
}  // namespace palpate
