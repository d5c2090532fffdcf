#include "core/recognition/samples/clean_patches.h"

#include <limits>
#include <span>

#include "core/recognition/samples/dwells.h"
#include "core/recognition/samples/stored_spikes.h"

namespace palpate {
namespace {

/// Half of the longer side of the box that holds all samples. [m]
double half_extent_of(const std::vector<StoredPatch>& patches) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      low = low.cwiseMin(sample.position_m);
      high = high.cwiseMax(sample.position_m);
    }
  }
  return 0.5 * (high - low).maxCoeff();
}

/// The patch without its repeats and dwells.
StoredPatch moving(const StoredPatch& patch, bool is_one_place, double default_sigma_m) {
  if (is_one_place) {
    const PatchSpan all{0, patch.samples.size()};
    return with_means(patch, std::span(&all, 1), default_sigma_m);
  }
  // The mean step grows as repeats leave: of nine in ten to ten times what it was, then once more.
  constexpr int kMostRounds = 4;
  StoredPatch result = patch;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<PatchSpan> repeats = repeats_of(result.samples);
    if (repeats.empty()) {
      break;
    }
    result = with_means(result, repeats, default_sigma_m);
  }
  const std::vector<PatchSpan> dwells = dwells_of(result.samples);
  return dwells.empty() ? result : with_means(result, dwells, default_sigma_m);
}

}  // namespace

void CleanPatches::look_at(const std::vector<StoredPatch>& patches, double default_sigma_m,
                           double false_alarm) {
  moved_.resize(patches.size());
  clean_.resize(patches.size());
  seen_.resize(patches.size());
  const double half_extent_m = half_extent_of(patches);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    // Asked each time: whether a patch is small depends on all.
    const Seen now{version_of(patch), is_one_place(patch.samples, default_sigma_m, half_extent_m)};
    if (!(seen_[p] == now)) {
      moved_[p] = moving(patch, now.is_one_place, default_sigma_m);
      clean_[p] = without_spikes(moved_[p], spikes_of(moved_[p].samples, false_alarm));
      seen_[p] = now;
    }
  }
}

std::size_t CleanPatches::moved_count() const {
  std::size_t count = 0;
  for (const StoredPatch& patch : moved_) {
    count += patch.samples.size();
  }
  return count;
}

void CleanPatches::clear() {
  moved_.clear();
  clean_.clear();
  seen_.clear();
}

}  // namespace palpate
