#include "core/recognition/samples/merged_samples.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Covariance of one contact; zeros if unknown. [m^2]
Eigen::Vector3d covariance_of(const StoredSample& sample, const SampleDetail& detail) {
  const double variance = sample.sigma_m * sample.sigma_m;
  return detail.covariance_m2.x() > 0.0 ? detail.covariance_m2
                                        : Eigen::Vector3d(variance, 0.0, variance);
}

/// Inverse variance of a measured normal. The standard deviation is at least a unit vector's
/// rounding.
double normal_weight(const SampleDetail& detail) {
  constexpr double kRounding = 1e-16;  // [rad]
  const double sigma = std::max(detail.normal_sigma_rad, kRounding);
  return 1.0 / (sigma * sigma);
}

}  // namespace

StoredSample merged(const StoredSample& a, const StoredSample& b) {
  StoredSample mean;
  mean.weight = a.weight + b.weight;
  mean.contacts = a.contacts + b.contacts;
  mean.position_m = (a.weight * a.position_m + b.weight * b.position_m) / mean.weight;
  if (a.sigma_m > 0.0 && b.sigma_m > 0.0) {
    mean.sigma_m = std::sqrt(
        mean.weight / (a.weight / (a.sigma_m * a.sigma_m) + b.weight / (b.sigma_m * b.sigma_m)));
  }
  return mean;
}

SampleDetail merged(const StoredSample& a, const SampleDetail& of_a, const StoredSample& b,
                    const SampleDetail& of_b) {
  SampleDetail mean;
  if (of_a.normal_sigma_rad > 0.0 && of_b.normal_sigma_rad > 0.0) {
    const double weight_a = normal_weight(of_a);
    const double weight_b = normal_weight(of_b);
    const Vec2 sum = weight_a * of_a.normal + weight_b * of_b.normal;
    // Normals that contradict each other have no mean.
    constexpr double kLeastAgreement = 0.1;
    if (sum.norm() > kLeastAgreement * (weight_a + weight_b)) {
      mean.normal = sum.normalized();
      mean.normal_sigma_rad = 1.0 / std::sqrt(weight_a + weight_b);
    }
  }
  if (of_a.covariance_m2.x() > 0.0 || of_b.covariance_m2.x() > 0.0) {
    const Eigen::Vector3d one = covariance_of(a, of_a);
    const Eigen::Vector3d other = covariance_of(b, of_b);
    if (one.x() > 0.0 && other.x() > 0.0) {
      mean.covariance_m2 = (a.weight * one + b.weight * other) / (a.weight + b.weight);
    }
  }
  return mean;
}

}  // namespace palpate
