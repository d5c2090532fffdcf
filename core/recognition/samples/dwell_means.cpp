#include "core/recognition/samples/dwell_means.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/recognition/samples/dwell_spikes.h"
#include "core/recognition/samples/dwells.h"
#include "core/recognition/samples/merged_samples.h"
#include "core/recognition/samples/sample_block.h"

namespace palpate {
namespace {

/// The number of independent contacts that the mean of `dwell` is worth. `of_all`: their total
/// weight.
double effective_weight(std::span<const StoredSample> samples, const PatchSpan& dwell,
                        double of_all, double default_sigma_m) {
  const SampleBlock block = block_of(samples, dwell.begin, dwell.end);
  double stated = 0.0;   // variance of one contact, as stated
  double scatter = 0.0;  // variance of one contact, as the samples show it
  double most = 0.0;
  for (std::size_t i = dwell.begin; i < dwell.end; ++i) {
    const StoredSample& sample = samples[i];
    const double sigma_m = sigma_m_of(sample, default_sigma_m);
    if (!(sigma_m > 0.0)) {
      stated = 0.0;
      break;
    }
    stated += sigma_m * sigma_m;
    scatter += 0.5 * sample.weight * (sample.position_m - block.mean).squaredNorm();
  }
  for (std::size_t i = dwell.begin; i < dwell.end; ++i) {
    most = std::max(most, samples[i].weight);
  }
  if (!(stated > 0.0)) {
    return most;
  }
  const double n = static_cast<double>(dwell.size());
  stated /= n;
  scatter /= n - 1.0;
  // The part of the stated variance that the samples do not show is a common error of them all. The
  // scatter itself is known to 1 in sqrt(n).
  constexpr double kDeviations = 3.0;
  const double same = std::max(stated - scatter * (1.0 + kDeviations / std::sqrt(n)), 0.0);
  // If neighbours share a part 1 - r of their error, n of them are worth n r / (2 - r).
  const double ratio = std::min(ratio_of(samples, block), 1.0);
  const double of_mean = same + stated / of_all * (2.0 - ratio) / ratio;
  return std::clamp(stated / of_mean, most, of_all);
}

/// with_means, of the dwells without their spikes.
StoredPatch with_means_of_good(StoredPatch patch, std::vector<PatchSpan> dwells,
                               double default_sigma_m, double false_alarm) {
  if (false_alarm > 0.0) {
    set_spikes_apart(default_sigma_m, false_alarm, &patch, &dwells);
  }
  return with_means(patch, dwells, default_sigma_m);
}

}  // namespace

StoredPatch with_means(const StoredPatch& patch, std::span<const PatchSpan> dwells,
                       double default_sigma_m) {
  StoredPatch result = patch;
  result.samples.clear();
  result.details.clear();
  const auto copy = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      result.samples.push_back(patch.samples[i]);
      if (!patch.details.empty()) result.details.push_back(patch.details[i]);
    }
  };
  std::size_t from = 0;
  for (const PatchSpan& dwell : dwells) {
    copy(from, dwell.begin);
    from = dwell.end;
    StoredSample mean = patch.samples[dwell.begin];
    SampleDetail detail;
    if (!patch.details.empty()) detail = patch.details[dwell.begin];
    for (std::size_t i = dwell.begin + 1; i < dwell.end; ++i) {
      if (!patch.details.empty()) {
        detail = merged(mean, detail, patch.samples[i], patch.details[i]);
      }
      mean = merged(mean, patch.samples[i]);
    }
    const double of_all = mean.weight;
    mean.weight = effective_weight(patch.samples, dwell, of_all, default_sigma_m);
    detail.normal_sigma_rad *= std::sqrt(of_all / mean.weight);
    result.samples.push_back(mean);
    if (!patch.details.empty()) result.details.push_back(detail);
  }
  copy(from, patch.samples.size());
  return result;
}

StoredPatch without_dwells(const StoredPatch& patch, double default_sigma_m, double false_alarm) {
  if (auto held = held_places(patch.samples); !held.empty()) {
    return with_means_of_good(patch, std::move(held), default_sigma_m, false_alarm);
  }
  // The mean step grows as repeats are removed: if nine in ten are repeats, ten times. So it takes
  // several rounds.
  constexpr int kMostRounds = 4;
  StoredPatch result = patch;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<PatchSpan> repeats = repeats_of(result.samples);
    if (repeats.empty()) {
      break;
    }
    result = with_means(result, repeats, default_sigma_m);
  }
  std::vector<PatchSpan> dwells = dwells_of(result.samples, default_sigma_m);
  return dwells.empty() ? result
                        : with_means_of_good(std::move(result), std::move(dwells), default_sigma_m,
                                             false_alarm);
}

StoredPatch mean_of_place(const StoredPatch& patch, double default_sigma_m, double false_alarm) {
  return with_means_of_good(patch, {{0, patch.samples.size()}}, default_sigma_m, false_alarm);
}

std::vector<Vec2> without_dwells(std::span<const Vec2> positions_m) {
  StoredPatch patch;
  for (const Vec2& position_m : positions_m) {
    patch.samples.push_back({position_m});
  }
  std::vector<Vec2> moved;
  for (const StoredSample& sample : without_dwells(patch, 0.0).samples) {
    moved.push_back(sample.position_m);
  }
  return moved;
}

}  // namespace palpate
