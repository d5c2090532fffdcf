#include "core/recognition/smooth/stated_form_error.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Points of unequal noise along a line.
FitData points_of_noise(int count, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> inverse_sigma(0.5, 2.0);
  FitData data;
  for (int i = 0; i < count; ++i) {
    FitPoint point;
    point.position = Vec2(i, 0.0);
    point.inverse_sigma = inverse_sigma(rng);
    data.points.push_back(point);
  }
  data.patches.push_back({0, data.points.size()});
  return data;
}

/// Largest variance of a unit combination of residuals, in units of their noise, where the form
/// error has the deviation and its correlation falls off over `length`.
double largest_variance(const FitData& data, double deviation, double length) {
  const auto n = static_cast<Eigen::Index>(data.points.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const FitPoint& a = data.points[static_cast<std::size_t>(i)];
      const FitPoint& b = data.points[static_cast<std::size_t>(j)];
      const double lag = (a.position - b.position).norm() / length;
      covariance(i, j) +=
          deviation * deviation * a.inverse_sigma * b.inverse_sigma * std::exp(-0.5 * lag * lag);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues()[n - 1];
}

TEST(StatedFormError, NoCombinationOfResidualsVariesMore) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kDeviation = 0.3;
  for (int i = 0; i < test::stress_count(10); ++i) {
    const FitData data = points_of_noise(30, rng);
    const double bound = 1.0 + coherent_variance(data, kDeviation);
    double before = 0.0;
    for (const double length : {0.1, 1.0, 10.0, 100.0}) {
      const double variance = largest_variance(data, kDeviation, length);
      EXPECT_LE(variance, bound);
      EXPECT_GE(variance, before);
      before = variance;
    }
    // And one does where all of it is coherent.
    EXPECT_NEAR(largest_variance(data, kDeviation, 1e9), bound, 1e-9 * bound);
  }
}

}  // namespace
}  // namespace palpate
