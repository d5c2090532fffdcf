#include "core/local/spikes.h"

#include <algorithm>
#include <cmath>

#include "core/local/noise.h"
#include "core/local/normal_law.h"
#include "core/local/residual_block.h"

namespace palpate {
namespace {

constexpr std::size_t kBlock = 16;
constexpr std::size_t kMinBlock = 8;

/// Noise is taken as at least kFormFactor * slope^4 * extent, which is what a quartic leaves of a
/// curve that turns by `slope` either way and whose curvature doubles along it: the fifth-degree
/// term 15 kappa^2 kappa_s / 5! has 8/63 of P_5 in it, that is 0.8 % of slope^4 extents.
constexpr double kFormFactor = 0.01;
/// ... and as this part of the extent: no touched part is truer to a quartic.
constexpr double kFormResolution = 1e-5;

/// Spikes of one block: the worst sample leaves until none is beyond the threshold; those that the
/// last fit explains after all come back.
void find_in_block(std::span<const Vec2> block, double sigma_m, double threshold,
                   ResidualBlock& residuals, std::vector<bool>& spike) {
  std::vector<bool> use(block.size(), true);
  spike.assign(block.size(), false);
  std::size_t found = 0;
  double limit = 0.0;
  while (true) {
    if (residuals.fit(block, use) != LocalStatus::Ok) {
      return;
    }
    const double turned = std::pow(std::min(residuals.steepest(), 1.0), 4);
    const double form = (kFormResolution + kFormFactor * turned) * residuals.extent_m();
    limit = threshold * std::max(sigma_m, form);
    std::size_t worst = block.size();
    double largest = limit;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (use[i] && std::abs(residuals.studentised(i)) > largest) {
        largest = std::abs(residuals.studentised(i));
        worst = i;
      }
    }
    if (worst == block.size()) {
      break;
    }
    if (++found > block.size() / 4) {
      return;
    }
    use[worst] = false;
  }
  if (residuals.steepest() > ResidualBlock::kMaxSlope) {
    return;
  }
  for (std::size_t i = 0; i < block.size(); ++i) {
    spike[i] = !use[i] && std::abs(residuals.studentised(i)) > limit;
  }
}

/// 16 samples, or twice that and so on until a block of mean spacing is long against the noise; at
/// most all samples.
std::size_t block_length(std::span<const Vec2> samples, double sigma_m) {
  std::size_t length = kBlock;
  while (length < samples.size()) {
    double extent = 0.0;
    int blocks = 0;
    for (std::size_t i = 0; i + length <= samples.size(); i += length) {
      extent += (samples[i + length - 1] - samples[i]).norm();
      ++blocks;
    }
    if (extent > blocks * ResidualBlock::kMinExtentSigmas * sigma_m) {
      break;
    }
    length *= 2;
  }
  return std::min(length, samples.size());
}

}  // namespace

Spikes find_spikes(std::span<const Vec2> samples, const SpikeOptions& options) {
  Spikes result;
  std::vector<Vec2> finite;
  std::vector<std::size_t> origin;
  finite.reserve(samples.size());
  origin.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].allFinite()) {
      finite.push_back(samples[i]);
      origin.push_back(i);
    } else {
      result.indices.push_back(i);
    }
  }
  result.sigma_m = options.sigma_m;
  result.status = finite.size() < kMinBlock ? LocalStatus::TooFewSamples : LocalStatus::Ok;
  if (result.status == LocalStatus::Ok && !(options.sigma_m > 0.0)) {
    const NoiseEstimate noise = estimate_noise(finite);
    result.status = noise.status;
    result.sigma_m = noise.sigma_m;
  }
  if (result.status != LocalStatus::Ok) {
    return result;
  }
  result.threshold = two_sided_normal_quantile(options.false_alarms_per_patch /
                                               static_cast<double>(finite.size()));

  // Each block answers for its middle half, the first and last ones also for the patch's ends.
  const std::size_t length = block_length(finite, result.sigma_m);
  ResidualBlock residuals;
  std::vector<bool> spike;
  std::size_t answered = 0;
  for (std::size_t first = 0; answered < finite.size(); first += length / 2) {
    const std::size_t start = std::min(first, finite.size() - length);
    const bool last = start + length == finite.size();
    const std::size_t until = last ? finite.size() : start + length - length / 4;
    find_in_block(std::span(finite).subspan(start, length), result.sigma_m, result.threshold,
                  residuals, spike);
    for (std::size_t i = answered; i < until; ++i) {
      if (spike[i - start]) {
        result.indices.push_back(origin[i]);
      }
    }
    answered = until;
  }
  std::sort(result.indices.begin(), result.indices.end());
  return result;
}

}  // namespace palpate
