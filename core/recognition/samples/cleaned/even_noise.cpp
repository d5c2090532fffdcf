#include "core/recognition/samples/cleaned/even_noise.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace palpate {
namespace {

/// Mean covariance of one contact of a sample; nullopt if none is stated. [m^2]
std::optional<Eigen::Matrix2d> mean_covariance(const StoredPatch& patch) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  bool any = false;
  for (std::size_t i = 0; i < patch.details.size(); ++i) {
    const Eigen::Vector3d& c = patch.details[i].covariance_m2;
    if (c.x() > 0.0) {
      sum += (Eigen::Matrix2d() << c.x(), c.y(), c.y(), c.z()).finished();
      any = true;
    } else {
      const double sigma_m = patch.samples[i].sigma_m;
      sum += sigma_m * sigma_m * Eigen::Matrix2d::Identity();
    }
  }
  return any ? std::optional<Eigen::Matrix2d>(sum / static_cast<double>(patch.details.size()))
             : std::nullopt;
}

}  // namespace

std::optional<std::vector<StoredSample>> with_even_noise(const StoredPatch& patch) {
  const auto covariance = mean_covariance(patch);
  if (!covariance) {
    return std::nullopt;
  }
  // To the mean noise, which is what the samples have for their sigma_m.
  const Eigen::Matrix2d stretch =
      std::sqrt(0.5 * covariance->trace()) *
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(*covariance).operatorInverseSqrt();
  std::vector<StoredSample> samples = patch.samples;
  const Vec2 first_m = samples.front().position_m;
  for (StoredSample& sample : samples) {
    sample.position_m = first_m + stretch * (sample.position_m - first_m);
  }
  return samples;
}

}  // namespace palpate
