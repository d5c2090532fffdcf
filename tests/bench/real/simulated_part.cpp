#include "tests/bench/real/simulated_part.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace palpate::bench {
namespace {

/// A normal vector of that mean and covariance, which may leave directions without any.
Eigen::VectorXd drawn(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                      std::mt19937_64& rng) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  std::normal_distribution<double> normal;
  Eigen::VectorXd sum = mean;
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    sum += normal(rng) * std::sqrt(std::max(eigen.eigenvalues()[k], 0.0)) *
           eigen.eigenvectors().col(k);
  }
  return sum;
}

}  // namespace

std::vector<Vec2> simulated(const std::vector<Vec2>& contacts, const Qualification& on_part,
                            const ProbeCharacter& probe, std::mt19937_64& rng) {
  NormalOffset offset = probe.offset;
  offset.coefficients_m = drawn(offset.coefficients_m, covariance_elsewhere(probe), rng);
  std::normal_distribution<double> normal;
  double drift_m = probe.deviation_m.value * normal(rng);
  std::vector<Vec2> points = contacts;
  for (const QualifiedSample& sample : on_part.samples) {
    if (sample.number > 0 && probe.deviation_length_m.value > 0.0) {
      const double step_m = (contacts[sample.number] - contacts[sample.number - 1]).norm();
      const double kept = std::exp(-step_m / probe.deviation_length_m.value);
      drift_m =
          kept * drift_m + std::sqrt(1.0 - kept * kept) * probe.deviation_m.value * normal(rng);
    }
    if (!sample.spike) {
      const double error_m =
          offset_at(offset, sample.normal_angle) + drift_m + probe.sigma_m.value * normal(rng);
      points[sample.number] += (error_m - sample.distance_m) *
                               Vec2(std::cos(sample.normal_angle), std::sin(sample.normal_angle));
    }
  }
  return points;
}

}  // namespace palpate::bench
