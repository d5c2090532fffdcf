#include "core/recognition/counted/unfollowed_samples.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include "core/local/spikes/block_survey.h"
#include "core/local/spikes/jumps.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"

namespace palpate {
namespace {

/// Of all samples, those that may be left out: seven must speak for a class for each that is not
/// asked. A spike in a bend spoils one section, of fewer than sixteen.
constexpr std::size_t kLeftOutOneIn = 8;

/// One flag per point: no polynomial follows it, or it is the lonely end of its section, to which
/// the polynomial bends wherever it is (block_survey.h).
std::vector<bool> unfollowed_points(const SmoothModel& smooth, const FitData& data) {
  std::vector<bool> flags(data.points.size(), false);
  for (const PatchSpan& patch : data.patches) {
    const auto is_far = [&](std::size_t i, std::size_t k, double extent) {
      return (data.points[i].position - data.points[k].position).norm() > kLonelyGap * extent;
    };
    for (std::size_t i = patch.begin; i < patch.end && patch.size() > 1; ++i) {
      const ReducedSection& section = section_of(smooth, i);
      const double extent = 2.0 * section.half_length;
      const bool first = i == patch.begin || &section_of(smooth, i - 1) != &section;
      const bool last = i + 1 == patch.end || &section_of(smooth, i + 1) != &section;
      flags[i] = section.kept || (first && !last && is_far(i, i + 1, extent)) ||
                 (last && !first && is_far(i, i - 1, extent));
    }
  }
  return flags;
}

/// A fit's feet on the points that are left.
ClassFit without_feet(ClassFit fit, const std::vector<bool>& is_out) {
  fit.rival.reset();
  if (fit.polynomial) {
    std::vector<double> feet;
    for (std::size_t k = 0; k < is_out.size(); ++k) {
      if (!is_out[k]) feet.push_back(fit.polynomial->t[k]);
    }
    fit.polynomial->t = std::move(feet);
  }
  return fit;
}

/// Whether a class that matters leaves no more than noise of the others, from where the weighing
/// has left it. A search costs ten times as much, and a part of no class has bends too.
bool may_fit_others(const Weighing& weighing, const std::vector<bool>& unfollowed,
                    std::span<const StoredPatch> others, const CurveOfOthers& matters,
                    WorkBudget& work) {
  std::vector<bool> is_out(weighing.smooth.reduced.points.size(), false);
  for (std::size_t i = 0; i < unfollowed.size(); ++i) {
    if (unfollowed[i]) {
      const ReducedSection& section = section_of(weighing.smooth, i);
      std::fill(is_out.begin() + static_cast<std::ptrdiff_t>(section.begin),
                is_out.begin() + static_cast<std::ptrdiff_t>(section.end), true);
    }
  }
  return std::any_of(weighing.coarse.begin(), weighing.coarse.end(), [&](const auto& fit) {
    if (!fit || fit->at_limit || !work.allows()) {
      return false;
    }
    const FitData& all = points_of(*fit, weighing.reduced);
    assert(all.points.size() == is_out.size());
    const FitData points = without_points(all, is_out);
    const ClassFit start = without_feet(*fit, is_out);
    const ClassFit left = settled(start, points, RivalOf::Other, work);
    if (!fits_well(left.chi2, residual_count(points))) {
      return false;
    }
    const auto canonical = to_canonical(left, points);
    const auto curve = canonical ? curve_of(*canonical, residual_noise_m(weighing)) : std::nullopt;
    return !curve || matters(*curve, others);
  });
}

}  // namespace

std::optional<std::vector<StoredPatch>> without_unfollowed(const Weighing& weighing,
                                                           const std::vector<bool>& flagged,
                                                           std::span<const StoredPatch> patches,
                                                           const CurveOfOthers& matters,
                                                           WorkBudget& work) {
  const std::vector<bool> unfollowed = unfollowed_points(weighing.smooth, weighing.data);
  std::vector<StoredPatch> fewer;
  std::size_t number = 0;  // among the samples of all patches
  std::size_t weighed = 0;
  std::size_t out = 0;
  for (const StoredPatch& patch : patches) {
    std::vector<bool> is_out(patch.samples.size(), false);
    for (std::size_t i = 0; i < is_out.size(); ++i, ++number) {
      if (number < flagged.size() && flagged[number]) {
        continue;
      }
      is_out[i] = unfollowed[weighed++];
    }
    const auto lost = static_cast<std::size_t>(std::count(is_out.begin(), is_out.end(), true));
    const bool is_whole = lost == is_out.size();  // a stroke in the bend alone: nothing judges it
    out += is_whole ? 0 : lost;
    fewer.push_back(is_whole ? patch : without_spikes(patch, is_out));
  }
  const bool holds = out > 0 && kLeftOutOneIn * out <= number &&
                     may_fit_others(weighing, unfollowed, fewer, matters, work);
  return holds ? std::optional(std::move(fewer)) : std::nullopt;
}

bool may_lack_spikes(std::span<const StoredPatch> all, std::span<const StoredPatch> left) {
  assert(all.size() == left.size());
  std::size_t lacking = 0;
  for (std::size_t p = 0; p < all.size(); ++p) {
    auto next = left[p].samples.begin();
    std::size_t run = 0;
    for (const StoredSample& sample : all[p].samples) {
      const auto found = std::find_if(
          next, left[p].samples.end(),
          [&](const StoredSample& candidate) { return candidate.position_m == sample.position_m; });
      const bool lacks = found == left[p].samples.end();
      run = lacks ? run + 1 : 0;
      lacking += lacks ? 1 : 0;
      next = lacks ? next : found + 1;
      if (run > kLongestRunOfSpikes) {
        return false;
      }
    }
  }
  return lacking <= most_set_aside(count_samples(all));
}

}  // namespace palpate
