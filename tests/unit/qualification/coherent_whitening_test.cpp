// The recursion that makes coherent noise white, against the covariance itself.
#include "core/qualification/coherent_whitening.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

TEST(CoherentWhitening, IsTheInverseOfTheCovariancesRoot) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform;
  const std::vector<StrokePlaces> strokes = {{0, 17}, {17, 40}};
  for (int run = 0; run < 20; ++run) {
    const Coherence coherence{3.0 * uniform(rng), 0.01 + uniform(rng)};
    std::vector<double> arc(40);
    std::vector<char> used(40, 1);
    for (std::size_t i = 0; i < arc.size(); ++i) {
      arc[i] = (i == 0 || i == 17 ? 0.0 : arc[i - 1]) + 0.1 * uniform(rng);
      used[i] = uniform(rng) < 0.2 ? 0 : 1;
    }
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] != 0) kept.push_back(static_cast<Eigen::Index>(i));
    }
    const auto n = static_cast<Eigen::Index>(kept.size());
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto a = static_cast<std::size_t>(kept[static_cast<std::size_t>(i)]);
        const auto b = static_cast<std::size_t>(kept[static_cast<std::size_t>(j)]);
        if ((a < 17) != (b < 17)) continue;
        covariance(i, j) += coherence.ratio * coherence.ratio *
                            std::exp(-std::abs(arc[a] - arc[b]) / coherence.length_m);
      }
    }
    Eigen::MatrixXd columns(40, 3);
    for (double& value : columns.reshaped()) value = uniform(rng) - 0.5;
    Eigen::MatrixXd some(n, 3);
    for (Eigen::Index i = 0; i < n; ++i)
      some.row(i) = columns.row(kept[static_cast<std::size_t>(i)]);
    const Eigen::MatrixXd expected = some.transpose() * covariance.llt().solve(some);
    const double log_determinant = whiten(coherence, strokes, arc, used, columns);
    EXPECT_TRUE((columns.transpose() * columns).isApprox(expected, 1e-12));
    const Eigen::MatrixXd lower = covariance.llt().matrixL();
    EXPECT_NEAR(log_determinant, 2.0 * lower.diagonal().array().log().sum(), 1e-10);
  }
}

}  // namespace
}  // namespace palpate
