#include "core/recognition/smooth/residual_correlation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/numerics/polynomials/orthogonal_polynomials.h"
#include "tests/support/most_of_poisson.h"
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

/// What the polynomial of that degree leaves of noise of which neighbours correlate so much.
RunOfResiduals left_by_polynomial(double correlation, std::size_t n, int degree,
                                  std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<double> x(n), r(n);
  const std::vector<double> w(n, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = 2.0 * static_cast<double>(i) / static_cast<double>(n - 1) - 1.0;
    const double rest = i == 0 ? 1.0 : std::sqrt(1.0 - correlation * correlation);
    r[i] = rest * normal(rng) + (i == 0 ? 0.0 : correlation * r[i - 1]);
  }
  const OrthogonalPolynomials fit(x, w, r, degree);
  for (std::size_t i = 0; i < n; ++i) {
    r[i] -= fit.evaluate(x[i], degree).value;
  }
  return {r, static_cast<std::size_t>(degree) + 1};
}

TEST(ResidualCorrelation, WhatPolynomialsTookIsPutBack) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kCorrelation = 0.6;
  std::vector<RunOfResiduals> runs;
  for (int i = 0; i < 200; ++i) {
    runs.push_back(left_by_polynomial(kCorrelation, 111, 6, rng));
  }
  // Of a time of 4 and 7 coefficients, 7 / 111 * 4 = 0.25 of the variance is taken. The
  // correlations 0.6 and 0.36 are above it; 0.216 and what follows are not seen, and are left out.
  constexpr double kSeen = 1.0 + 2.0 * (0.6 + 0.36);
  // Of 22,200 samples, over so few lags: 2.9 sqrt(2 * 5 / 22200) = 0.06. A coefficient takes a
  // little less than that many variances, for it is no constant.
  EXPECT_NEAR(correlation_time(runs), kSeen, 4 * 0.06);
  for (RunOfResiduals& run : runs) {
    run.parameters = 0;
  }
  EXPECT_LT(correlation_time(runs), kSeen - 0.5);
}

TEST(ResidualCorrelation, WhatPolynomialsLeaveOfWhiteNoiseIsWhite) {
  std::mt19937_64 rng = test::test_rng();
  constexpr int kTrials = 2000;
  int coloured = 0;
  int told = 0;  // where neighbours correlate by a half, as the two sections of 55 show
  for (int trial = 0; trial < kTrials; ++trial) {
    for (const double correlation : {0.0, 0.5}) {
      const std::vector<RunOfResiduals> runs = {left_by_polynomial(correlation, 55, 5, rng),
                                                left_by_polynomial(correlation, 55, 5, rng)};
      (correlation > 0.0 ? told : coloured) += correlation_time(runs) > 1.0 ? 1 : 0;
    }
  }
  EXPECT_LE(coloured, test::most_of_poisson(1e-3 * kTrials));
  // Their sum is then (0.5 - 3 x 6 / 55) / (1 - 3 x 6 / 55) + 6 / 55 of a variance, 3.4 of its
  // deviations 1 / sqrt(98), above the 3.1 that one in a thousand exceeds.
  EXPECT_GT(told, kTrials / 2);
}

TEST(ResidualCorrelation, SlowNoiseLeavesASectionATenthAtLeast) {
  std::mt19937_64 rng = test::test_rng();
  constexpr int kTrials = 2000;
  std::vector<double> shown;
  for (int trial = 0; trial < kTrials; ++trial) {
    double sum = 0.0;
    for (const double r : left_by_polynomial(0.95, 111, 3, rng).residuals) {
      sum += r * r;
    }
    shown.push_back(sum / 111.0);
  }
  std::sort(shown.begin(), shown.end());
  std::cout << "  of the variance: median " << shown[kTrials / 2] << ", one in a hundred "
            << shown[kTrials / 100] << "\n";
  EXPECT_GT(shown[kTrials / 100], 0.1);
}

TEST(ResidualCorrelation, WhatSwingsAveragesOut) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  // A swing of 15 samples beside white noise of a third of it. Over whole swings its mean is 0.
  std::vector<double> r(300);
  for (std::size_t i = 0; i < r.size(); ++i) {
    r[i] = std::sin(2.0 * kPi * static_cast<double>(i) / 15.0) + 0.3 * normal(rng);
  }
  EXPECT_EQ(correlation_of(straight_data(r.size()), r).time, 1.0);
}

TEST(ResidualCorrelation, NothingAndZerosAreWhite) {
  EXPECT_EQ(correlation_of(FitData{}, {}).time, 1.0);
  const std::vector<double> zeros(10, 0.0);
  EXPECT_EQ(correlation_of(straight_data(10), zeros).time, 1.0);
}

}  // namespace
}  // namespace palpate
