#include "core/recognition/smooth/residual_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

FitData straight_data(std::size_t n) {
  FitData data;
  for (std::size_t i = 0; i < n; ++i) {
    FitPoint point;
    point.position = {0.01 * static_cast<double>(i), 0.0};
    data.points.push_back(point);
  }
  data.patches.push_back({0, n});
  return data;
}

TEST(ResidualCorrelation, WhiteNoiseIsWhite) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  const FitData data = straight_data(300);
  int coloured = 0;
  constexpr int kTrials = 1000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> r(300);
    for (double& value : r) {
      value = normal(rng);
    }
    coloured += correlation_of(data, r).time > 1.0 ? 1 : 0;
  }
  // One in a thousand by construction; five or more has probability 0.004.
  EXPECT_LT(coloured, 5);
}

TEST(ResidualCorrelation, FirstOrderProcessHasItsIntegratedTime) {
  // r_i = rho r_{i-1} + noise: time = (1 + rho) / (1 - rho) = 9 for rho = 0.8.
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  const FitData data = straight_data(20000);
  std::vector<double> r(20000, 0.0);
  for (std::size_t i = 1; i < r.size(); ++i) {
    r[i] = 0.8 * r[i - 1] + normal(rng);
  }
  const ResidualCorrelation correlation = correlation_of(data, r);
  // The estimate's own spread, about time * sqrt(2 (2 lags + 1) / n) with some 40 lags: 0.8.
  EXPECT_NEAR(correlation.time, 9.0, 2.5);
  EXPECT_NEAR(correlation.length, correlation.time * 0.01, 1e-3);
}

TEST(ResidualCorrelation, NothingAndZerosAreWhite) {
  EXPECT_EQ(correlation_of(FitData{}, {}).time, 1.0);
  const std::vector<double> zeros(10, 0.0);
  EXPECT_EQ(correlation_of(straight_data(10), zeros).time, 1.0);
}

}  // namespace
}  // namespace palpate
