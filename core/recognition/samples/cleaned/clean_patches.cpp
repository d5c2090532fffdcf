#include "core/recognition/samples/cleaned/clean_patches.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/recognition/samples/cleaned/even_noise.h"
#include "core/recognition/samples/cleaned/passes.h"
#include "core/recognition/samples/cleaned/relative_noise.h"
#include "core/recognition/samples/cleaned/repeated_touches.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"
#include "core/recognition/samples/dwell_means.h"
#include "core/recognition/samples/dwells.h"

namespace palpate {
namespace {

/// The patch without repeats and dwells, the spikes of these marked.
StoredPatch moving(const StoredPatch& patch, bool is_one_place, const CleanOptions& options) {
  return is_one_place ? mean_of_place(patch, options.default_sigma_m, options.false_alarm)
                      : without_dwells(patch, options.default_sigma_m, options.false_alarm);
}

/// Converts turns that were found without spikes to indices among all samples. A turn is the
/// farthest sample on the way, even if it was taken for a spike.
Reversals among_all(std::span<const StoredSample> all, const std::vector<bool>& is_spike,
                    const Reversals& turns) {
  std::vector<std::size_t> kept;
  kept.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!is_spike[i]) kept.push_back(i);
  }
  // So many samples farther back, noise does not reverse the direction of the way.
  constexpr std::size_t kBehind = 4;
  Reversals result;
  std::size_t before = 0;  // the first sample kept after the turn before
  const auto add = [&](std::size_t k, std::vector<std::size_t>* to) {
    const std::size_t behind = kept[std::max(before, k - 1 - std::min(k - 1, kBehind))];
    const Vec2 way = all[kept[k - 1]].position_m - all[behind].position_m;
    std::size_t turn = behind;
    for (std::size_t i = behind + 1; i < kept[k]; ++i) {
      if ((all[i].position_m - all[turn].position_m).dot(way) > 0.0) turn = i;
    }
    to->push_back(turn + 1);
    before = k;
  };
  auto cusp = turns.cusps.begin();
  for (const std::size_t k : turns.returns) {
    for (; cusp != turns.cusps.end() && *cusp < k; ++cusp) add(*cusp, &result.cusps);
    add(k, &result.returns);
  }
  for (; cusp != turns.cusps.end(); ++cusp) add(*cusp, &result.cusps);
  return result;
}

bool has_any(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// The spikes of a patch, each part of it searched by itself: no polynomial follows a stroke around
/// a turn, so that good samples look like spikes there. The farthest sample at a cusp may be of
/// either arm and bends the polynomial of the other: it waits for a class to judge it. The parts
/// share the probability of a false alarm by their samples.
std::vector<bool> spikes_between(const Reversals& turns, std::span<const StoredSample> samples,
                                 std::span<const RelativeNoise> noise, double false_alarm,
                                 WorkBudget& work) {
  std::vector<PatchSpan> gaps;  // between parts: nothing, or the sample at a cusp
  for (const std::size_t turn : turns.returns) gaps.push_back({turn, turn});
  for (const std::size_t turn : turns.cusps) gaps.push_back({turn - 1, turn});
  gaps.push_back({samples.size(), samples.size()});
  std::sort(gaps.begin(), gaps.end(),
            [](const PatchSpan& a, const PatchSpan& b) { return a.begin < b.begin; });
  std::vector<bool> is_spike;
  is_spike.reserve(samples.size());
  bool after_cusp = false;
  for (const PatchSpan& gap : gaps) {
    const std::size_t begin = is_spike.size();
    const auto part = samples.subspan(begin, gap.begin - begin);
    const double share = static_cast<double>(part.size()) / static_cast<double>(samples.size());
    const CuspEnds cusps{after_cusp, gap.size() > 0};
    const std::vector<bool> of_part =
        spikes_of(part, false_alarm * share, work, cusps,
                  noise.empty() ? noise : noise.subspan(begin, part.size()));
    is_spike.insert(is_spike.end(), of_part.begin(), of_part.end());
    is_spike.resize(gap.end, false);
    after_cusp = cusps.last;
  }
  return is_spike;
}

/// The passes of a patch without its spikes. Every second one is reversed (passes_of).
std::vector<StoredPatch> each_without_spikes(std::span<const StoredPatch> passes,
                                             const std::vector<bool>& is_spike) {
  std::vector<StoredPatch> clean;
  clean.reserve(passes.size());
  auto begin = is_spike.begin();
  for (const StoredPatch& pass : passes) {
    const auto end = begin + static_cast<std::ptrdiff_t>(pass.samples.size());
    std::vector<bool> of_pass(begin, end);
    if (clean.size() % 2 == 1) std::reverse(of_pass.begin(), of_pass.end());
    clean.push_back(without_spikes(pass, of_pass));
    begin = end;
  }
  return clean;
}

/// The turns of a patch without the samples that are flagged and those at `cusps`, which spikes may
/// be, by index among all.
Reversals turns_without(std::vector<bool> is_spike, std::span<const std::size_t> cusps,
                        std::span<const StoredSample> samples, double default_sigma_m) {
  for (const std::size_t cusp : cusps) is_spike[cusp - 1] = true;
  return among_all(samples, is_spike,
                   reversals_of(without_spikes(samples, is_spike), default_sigma_m));
}

/// Where a patch is cut into passes, by index of the first sample after each, and its spikes.
struct Cut {
  std::vector<std::size_t> returns;
  std::vector<bool> is_spike;
};

/// Where a patch is cut, and its spikes. Among many spikes some follow each other in runs that turn
/// back: the parts between their turns are too short to show them, and no block judges the sample
/// at a cusp. So where other turns are left without these and what is found, the
/// patch is searched as a whole, to find those that made or hid a turn.
Cut cut_of(const StoredPatch& patch, const CleanOptions& options, WorkBudget& work) {
  const double default_sigma_m = options.default_sigma_m;
  const std::vector<RelativeNoise> noise =
      relative_noise(patch, default_sigma_m, options.form_deviation_m);
  const auto spikes = [&](const Reversals& turns) {
    return spikes_between(turns, patch.samples, noise, options.false_alarm, work);
  };
  const auto even = with_even_noise(patch);
  const std::span<const StoredSample> samples = even ? *even : patch.samples;
  Reversals turns = reversals_of(samples, default_sigma_m);
  std::vector<bool> is_spike = spikes(turns);
  if ((has_any(is_spike) || !turns.cusps.empty()) &&
      turns_without(is_spike, turns.cusps, samples, default_sigma_m) != turns) {
    if (turns != Reversals{}) {
      is_spike = spikes({});
    }
    turns = turns_without(is_spike, {}, samples, default_sigma_m);
    if (turns != Reversals{}) {
      is_spike = spikes(turns);
    }
  }
  return {std::move(turns.returns), std::move(is_spike)};
}

/// The same, where spikes of dwells have no part in what is found, and are spikes.
Cut cut_beside_dwells(const StoredPatch& patch, const CleanOptions& options, WorkBudget& work) {
  std::vector<bool> is_spike;
  is_spike.reserve(patch.samples.size());
  for (const StoredSample& sample : patch.samples) is_spike.push_back(sample.is_off_dwell);
  if (!has_any(is_spike)) {
    return cut_of(patch, options, work);
  }
  Cut cut = cut_of(without_spikes(patch, is_spike), options, work);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < is_spike.size(); ++i) {
    if (!is_spike[i]) kept.push_back(i);
  }
  for (std::size_t k = 0; k < kept.size(); ++k) is_spike[kept[k]] = cut.is_spike[k];
  for (std::size_t& end : cut.returns) end = kept[end - 1] + 1;
  cut.is_spike = std::move(is_spike);
  return cut;
}

}  // namespace

void CleanPatches::update(std::span<const StoredPatch> patches, const CleanOptions& options,
                          WorkBudget& work) {
  const double default_sigma_m = options.default_sigma_m;
  seen_.resize(patches.size());
  moved_.clear();
  clean_.clear();
  const double extent_m = half_extent_m(box_of(patches));
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    if (patch.samples.size() == 1) {  // a touch: it neither dwells nor turns back
      seen_[p] = Seen{};
      moved_.push_back(patch);
      clean_.push_back(patch);
      continue;
    }
    // Computed every time: whether a patch is small depends on all patches.
    Seen now{version_of(patch), is_one_place(patch.samples, default_sigma_m, extent_m)};
    Seen& seen = seen_[p];
    if (!(seen.version == now.version) || seen.is_one_place != now.is_one_place) {
      const StoredPatch moved = moving(patch, now.is_one_place, options);
      const Cut cut = cut_beside_dwells(moved, options, work);
      now.moved = passes_of(moved, cut.returns);
      now.clean = each_without_spikes(now.moved, cut.is_spike);
      seen = std::move(now);
      if (work.was_cut()) {
        seen.version = PatchVersion{};  // none that has a sample
      }
    }
    moved_.insert(moved_.end(), seen.moved.begin(), seen.moved.end());
    clean_.insert(clean_.end(), seen.clean.begin(), seen.clean.end());
  }
  merge_repeated_touches(default_sigma_m, &moved_, &clean_);
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

std::size_t CleanPatches::moved_count() const { return count_samples(moved_); }

void CleanPatches::clear() {
  moved_.clear();
  clean_.clear();
  seen_.clear();
}

}  // namespace palpate
