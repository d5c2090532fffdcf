#include "core/recognition/samples/cleaned/relative_noise.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/quantile.h"

namespace palpate {
namespace {

/// Direction of the way past sample i: of the parabola through samples before and after it, near an
/// end through the first three. They are so far apart that noise of `sigma_m` tells the direction,
/// if any are. Zero where the way is none.
Vec2 way_past(std::size_t i, std::span<const StoredSample> samples, double sigma_m) {
  Vec2 way = Vec2::Zero();
  const std::size_t most = (samples.size() - 1) / 2;
  for (std::size_t reach = 1; reach <= most; reach *= 2) {
    const std::size_t first = std::min(i - std::min(i, reach), samples.size() - 1 - 2 * reach);
    const double t = static_cast<double>(i - first) / static_cast<double>(reach);  // in [0, 2]
    const auto at = [&](std::size_t k) { return samples[first + k * reach].position_m; };
    way = (t - 0.5) * (at(2) - at(1)) + (1.5 - t) * (at(1) - at(0));
    if (way.norm() > ResidualBlock::kMinExtentSigmas * sigma_m) {
      break;
    }
  }
  return way.isZero(0.0) ? way : way.normalized();
}

/// Noise of one contact of a sample where the stroke goes `way`, as standard deviations. [m]
RelativeNoise noise_of(const StoredSample& sample, const SampleDetail& detail, const Vec2& way,
                       double default_sigma_m) {
  const double sigma_m = sigma_m_of(sample, default_sigma_m);
  const Eigen::Vector3d& c = detail.covariance_m2;
  if (!(c.x() > 0.0) || way.isZero(0.0)) {
    return {sigma_m, sigma_m};
  }
  const double mixed = 2.0 * way.x() * way.y() * c.y();
  const Vec2 squares = way.cwiseAbs2();
  return {std::sqrt(squares.y() * c.x() - mixed + squares.x() * c.z()),
          std::sqrt(squares.x() * c.x() + mixed + squares.y() * c.z())};
}

}  // namespace

std::vector<RelativeNoise> relative_noise(const StoredPatch& patch, double default_sigma_m,
                                          double form_deviation_m) {
  const std::span<const StoredSample> samples = patch.samples;
  if (patch.details.empty() && std::ranges::all_of(samples, [&](const StoredSample& sample) {
        return sample.sigma_m == samples.front().sigma_m && sample.weight == samples.front().weight;
      })) {
    return {};
  }
  std::vector<RelativeNoise> noise;
  noise.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SampleDetail detail = patch.details.empty() ? SampleDetail{} : patch.details[i];
    const Vec2 way =
        detail.covariance_m2.x() > 0.0 ? way_past(i, samples, samples[i].sigma_m) : Vec2::Zero();
    const RelativeNoise one = noise_of(samples[i], detail, way, default_sigma_m);
    if (!(one.across > 0.0 && one.along > 0.0)) {
      return {};
    }
    const auto of_mean = [&](double sigma_m) {
      return std::hypot(sigma_m / std::sqrt(samples[i].weight), form_deviation_m);
    };
    noise.push_back({of_mean(one.across), of_mean(one.along)});
  }
  std::vector<double> across;
  across.reserve(noise.size());
  for (const RelativeNoise& one : noise) {
    across.push_back(one.across);
  }
  const double median = median_of(across);
  for (RelativeNoise& one : noise) {
    one = {one.across / median, one.along / median};
  }
  return noise;
}

}  // namespace palpate
