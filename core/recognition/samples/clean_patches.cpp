#include "core/recognition/samples/clean_patches.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "core/recognition/samples/dwells.h"
#include "core/recognition/samples/passes.h"
#include "core/recognition/samples/stored_spikes.h"

namespace palpate {
namespace {

/// Half the longer side of the box that holds all samples. [m]
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

/// The patch without repeats and dwells.
StoredPatch moving(const StoredPatch& patch, bool is_one_place, double default_sigma_m) {
  const PatchSpan all{0, patch.samples.size()};
  return is_one_place ? with_means(patch, std::span(&all, 1), default_sigma_m)
                      : without_dwells(patch, default_sigma_m);
}

/// Converts `returns`, found without spikes, to indices among all samples. The turn is the farthest
/// sample on the way, even if it was taken for a spike.
std::vector<std::size_t> returns_among_all(std::span<const StoredSample> all,
                                           const std::vector<bool>& is_spike,
                                           std::span<const std::size_t> returns) {
  std::vector<std::size_t> kept;
  kept.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!is_spike[i]) kept.push_back(i);
  }
  // So many samples farther back, noise does not reverse the direction of the way.
  constexpr std::size_t kBehind = 4;
  std::vector<std::size_t> result;
  for (const std::size_t k : returns) {
    const std::size_t behind = kept[k - 1 - kBehind];
    const Vec2 way = all[kept[k - 1]].position_m - all[behind].position_m;
    std::size_t turn = behind;
    for (std::size_t i = behind + 1; i < kept[k]; ++i) {
      if ((all[i].position_m - all[turn].position_m).dot(way) > 0.0) turn = i;
    }
    result.push_back(turn + 1);
  }
  return result;
}

bool has_any(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// Whether any part of a patch, which begins at 0 or at one of `cuts`, has a spike.
bool has_spikes_between(std::span<const StoredSample> samples, std::span<const std::size_t> cuts,
                        double false_alarm, WorkBudget& work) {
  for (std::size_t part = 0; part <= cuts.size(); ++part) {
    const std::size_t begin = part == 0 ? 0 : cuts[part - 1];
    const std::size_t end = part == cuts.size() ? samples.size() : cuts[part];
    if (has_any(spikes_of(samples.subspan(begin, end - begin), false_alarm, work))) {
      return true;
    }
  }
  return false;
}

/// Cuts a patch into passes, with and without spikes. Where a stroke turns back, no polynomial
/// follows it and good samples look like spikes, so spikes are searched between the turns. A spike
/// also turns back, so where there are any, the turns are found once more without them.
void clean_passes(StoredPatch patch, double false_alarm, std::vector<StoredPatch>* passes,
                  std::vector<StoredPatch>* clean, WorkBudget& work) {
  const std::vector<std::size_t> seen_returns = returns_of(patch.samples);
  if (!seen_returns.empty() &&
      !has_spikes_between(patch.samples, seen_returns, false_alarm, work)) {
    *passes = passes_of(patch, seen_returns);
    *clean = *passes;
    return;
  }
  const std::vector<bool> is_spike = spikes_of(patch.samples, false_alarm, work);
  StoredPatch rest = without_spikes(patch, is_spike);
  const std::vector<std::size_t> returns =
      has_any(is_spike) ? returns_of(rest.samples) : seen_returns;
  if (returns.empty()) {
    passes->push_back(std::move(patch));
    clean->push_back(std::move(rest));
    return;
  }
  *passes = passes_of(patch, returns_among_all(patch.samples, is_spike, returns));
  for (const StoredPatch& pass : *passes) {
    clean->push_back(without_spikes(pass, spikes_of(pass.samples, false_alarm, work)));
  }
}

}  // namespace

void CleanPatches::update(const std::vector<StoredPatch>& patches, double default_sigma_m,
                          double false_alarm, WorkBudget& work) {
  seen_.resize(patches.size());
  moved_.clear();
  clean_.clear();
  const double half_extent_m = half_extent_of(patches);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    if (patch.samples.size() == 1) {  // a touch: it neither dwells nor turns back
      seen_[p] = Seen{};
      moved_.push_back(patch);
      clean_.push_back(patch);
      continue;
    }
    // Computed every time: whether a patch is small depends on all patches.
    Seen now{version_of(patch), is_one_place(patch.samples, default_sigma_m, half_extent_m)};
    Seen& seen = seen_[p];
    if (!(seen.version == now.version) || seen.is_one_place != now.is_one_place) {
      clean_passes(moving(patch, now.is_one_place, default_sigma_m), false_alarm, &now.moved,
                   &now.clean, work);
      seen = std::move(now);
      if (work.was_cut()) {
        seen.version = PatchVersion{};  // none that has a sample
      }
    }
    moved_.insert(moved_.end(), seen.moved.begin(), seen.moved.end());
    clean_.insert(clean_.end(), seen.clean.begin(), seen.clean.end());
  }
}

std::size_t CleanPatches::dwelling_count() const {
  double count = 0.0;
  for (const StoredPatch& patch : moved_) {
    for (const StoredSample& sample : patch.samples) {
      count += std::max(sample.contacts - patch.contacts_per_sample, 0.0);
    }
  }
  return static_cast<std::size_t>(count);
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
