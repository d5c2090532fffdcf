#include "core/local/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"

namespace palpate {
namespace {

// The quartic's five unknowns and eleven residuals, which determine the noise to a fifth, 1 /
// sqrt(22).
constexpr std::size_t kLongBlock = 16;
constexpr std::size_t kShortBlock = 8;  // the unknowns and three residuals

/// Residuals with |r| <= kCut * (median / kMedianOfNormal) are kept. Of a normal distribution 6 in
/// 10^5 are removed; of the spikes that matter, nearly all.
constexpr double kCut = 4.0;

/// The shorter blocks are used if the variance of the longer ones exceeds theirs by more than
/// kExcess standard deviations of the ratio (one-sided 1 %).
constexpr double kExcess = 2.33;

struct BlockNoise {
  NoiseEstimate noise;
  double mean_extent_m = 0.0;
};

/// Uses blocks of at least `block` samples, of lengths as equal as possible.
BlockNoise from_blocks(std::span<const Vec2> samples, std::size_t block, NoiseScratch* scratch) {
  BlockNoise result;
  const std::size_t blocks = samples.size() / block;
  std::vector<double>& sizes = scratch->sizes;
  sizes.clear();
  ResidualBlock& residuals = scratch->residuals;
  int fitted = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = b * samples.size() / blocks;
    const std::size_t count = (b + 1) * samples.size() / blocks - first;
    LocalStatus status = residuals.fit(samples.subspan(first, count));
    if (status == LocalStatus::Ok && residuals.steepest() > ResidualBlock::kMaxSlope) {
      status = LocalStatus::TurnsTooFar;
    }
    if (status != LocalStatus::Ok) {
      result.noise.status = status;
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      sizes.push_back(std::abs(residuals.studentised(i)));
    }
    result.noise.dof += static_cast<int>(count) - ResidualBlock::kUnknowns;
    result.mean_extent_m += residuals.extent_m();
    ++fitted;
  }
  if (fitted > 0) {
    result.mean_extent_m /= fitted;
    result.noise.status = LocalStatus::Ok;
    result.noise.sigma_m = robust_sigma(sizes);
  }
  return result;
}

/// The noise by how neighbours go to and fro: a median of second differences. A path leaves as much
/// only if it turns by a radian from one sample to the next.
double to_and_fro(std::span<const Vec2> samples, NoiseScratch* scratch) {
  constexpr double kVariances = 6.0;  // 1 + 4 + 1, of a second difference
  std::vector<double>& sizes = scratch->sizes;
  sizes.clear();
  sizes.reserve(2 * samples.size());
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const Vec2 second = samples[i - 1] - 2.0 * samples[i] + samples[i + 1];
    sizes.push_back(std::abs(second.x()));
    sizes.push_back(std::abs(second.y()));
  }
  return median_of(sizes) / (kMedianOfNormal * std::sqrt(kVariances));
}

/// Uses blocks of at least `block` samples, or longer ones if these are too short compared with the
/// noise: the one that they show, or `neighbours` if that is larger. Noise turns the path of blocks
/// that are too short by more than their fit may turn. The few that are fitted all the same are
/// those with little noise by chance, beside which they are long.
NoiseEstimate from_resolved_blocks(std::span<const Vec2> samples, std::size_t block,
                                   double neighbours, NoiseScratch* scratch) {
  BlockNoise result = from_blocks(samples, block, scratch);
  const auto unresolved = [&] {
    return result.noise.status == LocalStatus::Unresolved ||
           result.mean_extent_m <=
               ResidualBlock::kMinExtentSigmas * std::max(result.noise.sigma_m, neighbours);
  };
  while (unresolved() && 2 * block <= samples.size()) {
    block *= 2;
    result = from_blocks(samples, block, scratch);
  }
  if (result.noise.status == LocalStatus::Ok && unresolved()) {
    return {LocalStatus::Unresolved, 0.0, 0};
  }
  return result.noise;
}

}  // namespace

double robust_sigma(std::vector<double>& sizes) {
  const double scale = median_of(sizes) / kMedianOfNormal;
  // If more than half of the residuals are exactly zero (quantised samples), there is no scale for
  // a cut.
  const double limit = scale > 0.0 ? kCut * scale : std::numeric_limits<double>::infinity();
  double sum = 0.0;
  int kept = 0;
  for (const double size : sizes) {
    if (size <= limit) {
      sum += size * size;
      ++kept;
    }
  }
  const double within = scale > 0.0 ? mean_square_within(kCut) : 1.0;
  return std::sqrt(sum / (kept * within));
}

NoiseEstimate estimate_noise(std::span<const Vec2> samples) {
  NoiseScratch scratch;
  return estimate_noise(samples, &scratch);
}

NoiseEstimate estimate_noise(std::span<const Vec2> samples, NoiseScratch* scratch) {
  std::vector<Vec2>& distinct = scratch->distinct;
  distinct.clear();
  distinct.reserve(samples.size());
  for (const Vec2& p : samples) {
    if (!p.allFinite()) {
      return {LocalStatus::NotFinite, 0.0, 0};
    }
    if (distinct.empty() || p != distinct.back()) {
      distinct.push_back(p);
    }
  }
  if (distinct.size() < kShortBlock) {
    return {distinct.size() < 2 && samples.size() >= kShortBlock ? LocalStatus::NoExtent
                                                                 : LocalStatus::TooFewSamples,
            0.0, 0};
  }
  const double neighbours = to_and_fro(distinct, scratch);
  const NoiseEstimate fine = from_resolved_blocks(distinct, kShortBlock, neighbours, scratch);
  if (distinct.size() < kLongBlock) {
    return fine;
  }
  const NoiseEstimate coarse = from_resolved_blocks(distinct, kLongBlock, neighbours, scratch);
  if (coarse.status != LocalStatus::Ok || fine.status != LocalStatus::Ok) {
    return coarse.status == LocalStatus::Ok ? coarse : fine;
  }
  const double ratio_sd = std::sqrt(2.0 / coarse.dof + 2.0 / fine.dof);
  const double limit = fine.sigma_m * std::sqrt(1.0 + kExcess * ratio_sd);
  return coarse.sigma_m > limit ? fine : coarse;
}

}  // namespace palpate
