#include "core/recognition/samples/cleaned/explained_spikes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

/// Signed length of the curve between two parameters, the short way round if it is closed. [m]
double arc_between(const Curve& curve, double from, double to) {
  const double period = domain(curve).period;
  return arc_length(curve, from, period > 0.0 ? from + std::remainder(to - from, period) : to);
}

/// The stretch of the curve that a stroke passed while its samples were lost.
struct Gap {
  double before = 0.0;
  double length_m = 0.0;  ///< signed length to the sample after it; negative against the parameter
};

/// The gap of `lost` samples before sample `next` of those kept. Before the first and after the
/// last kept sample, each lost one may be as far from its neighbour as the longest step of the
/// stroke.
Gap gap_before(std::size_t next, std::size_t lost, std::span<const StoredSample> kept,
               const Curve& curve, const Pose2& world_T_curve) {
  const auto parameter_of = [&](std::size_t i) {
    return foot_point(curve, world_T_curve.to_local(kept[i].position_m)).t;
  };
  if (next > 0 && next < kept.size()) {
    const double before = parameter_of(next - 1);
    return {before, arc_between(curve, before, parameter_of(next))};
  }
  double longest_m = 0.0;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    longest_m = std::max(longest_m, (kept[i].position_m - kept[i - 1].position_m).norm());
  }
  const std::size_t end = next == 0 ? 0 : kept.size() - 1;
  const std::size_t inner = next == 0 ? 1 : kept.size() - 2;
  const double from = parameter_of(end);
  return {from, std::copysign(static_cast<double>(lost) * longest_m,
                              arc_between(curve, parameter_of(inner), from))};
}

/// Number of consecutive samples lost from index `from` on, before sample `next` of those kept.
std::size_t lost_from(std::size_t from, std::size_t next, std::span<const StoredSample> all,
                      std::span<const StoredSample> kept) {
  std::size_t end = from;
  while (end < all.size() &&
         (next == kept.size() || all[end].position_m != kept[next].position_m)) {
    ++end;
  }
  return end - from;
}

/// True if the stroke passed t within the gap, up to the noise along the curve.
bool passes(const Gap& gap, const Curve& curve, double t, double noise_m) {
  const double on_m = arc_between(curve, gap.before, t);
  return on_m >= std::min(0.0, gap.length_m) - noise_m &&
         on_m <= std::max(0.0, gap.length_m) + noise_m;
}

/// Puts samples [begin, end) of `all` in the patch, before or after those that it has.
void put(const StoredPatch& all, std::size_t begin, std::size_t end, bool before,
         StoredPatch* patch) {
  const auto part = [&](const auto& of_all, auto* of_patch) {
    of_patch->insert(before ? of_patch->begin() : of_patch->end(),
                     of_all.begin() + static_cast<std::ptrdiff_t>(begin),
                     of_all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  part(all.samples, &patch->samples);
  if (!all.details.empty()) part(all.details, &patch->details);
}

}  // namespace

std::optional<std::vector<StoredPatch>> with_runs_at_ends(std::span<const StoredPatch> all,
                                                          std::span<const StoredPatch> clean) {
  assert(all.size() == clean.size());
  constexpr std::size_t kLeastRun = 2;
  std::vector<StoredPatch> result(clean.begin(), clean.end());
  bool any = false;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const std::vector<StoredSample>& samples = all[p].samples;
    const std::vector<StoredSample>& kept = clean[p].samples;
    if (kept.empty() || kept.size() == samples.size()) {
      continue;
    }
    const auto step = [&](std::size_t i) {
      return (samples[i + 1].position_m - samples[i].position_m).norm();
    };
    std::size_t begin = samples.size();  // of what is kept, among all
    std::size_t end = 0;
    double longest = 0.0;
    for (std::size_t i = 0, k = 0; i < samples.size() && k < kept.size(); ++i) {
      if (samples[i].position_m == kept[k].position_m) {
        longest = end == i && end > begin ? std::max(longest, step(i - 1)) : longest;
        begin = std::min(begin, i);
        end = i + 1;
        ++k;
      }
    }
    assert(end > begin);
    const auto goes_on = [&](std::size_t from, std::size_t to) {
      bool goes = true;
      for (std::size_t i = from; i < to; ++i) {
        goes = goes && step(i) <= longest;
      }
      return goes;
    };
    const bool at_begin = begin >= kLeastRun && goes_on(0, begin);
    const bool at_end = samples.size() - end >= kLeastRun && goes_on(end - 1, samples.size() - 1);
    if (at_begin) {
      put(all[p], 0, begin, true, &result[p]);
    }
    if (at_end) {
      put(all[p], end, samples.size(), false, &result[p]);
    }
    any = any || at_begin || at_end;
  }
  return any ? std::optional(std::move(result)) : std::nullopt;
}

std::optional<std::vector<StoredPatch>> with_explained_spikes(std::span<const StoredPatch> all,
                                                              std::span<const StoredPatch> clean,
                                                              const Curve& curve,
                                                              const Pose2& world_T_curve,
                                                              double noise_m, double limit) {
  assert(all.size() == clean.size());
  std::vector<StoredPatch> result(clean.begin(), clean.end());
  bool any = false;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const std::vector<StoredSample>& kept = clean[p].samples;
    if (kept.size() == all[p].samples.size() || kept.size() < 2) {
      continue;
    }
    StoredPatch& taken = result[p];
    taken.samples.clear();
    taken.details.clear();
    const auto take = [&](std::size_t i) {
      taken.samples.push_back(all[p].samples[i]);
      if (!all[p].details.empty()) taken.details.push_back(all[p].details[i]);
    };
    std::size_t next = 0;
    std::size_t first_lost = 0;
    Gap gap;
    bool is_gap_known = false;
    for (std::size_t i = 0; i < all[p].samples.size(); ++i) {
      const StoredSample& sample = all[p].samples[i];
      if (next < kept.size() && kept[next].position_m == sample.position_m) {
        take(i);
        ++next;
        first_lost = i + 1;
        is_gap_known = false;
        continue;
      }
      const FootPoint foot = foot_point(curve, world_T_curve.to_local(sample.position_m));
      const double sigma = sigma_m_of(sample, noise_m) / std::sqrt(sample.weight);
      if (std::abs(std::abs(foot.distance) - all[p].context.tip_radius_m) > limit * sigma) {
        continue;
      }
      if (!is_gap_known) {
        const std::size_t lost = lost_from(first_lost, next, all[p].samples, kept);
        gap = gap_before(next, lost, kept, curve, world_T_curve);
        is_gap_known = true;
      }
      if (passes(gap, curve, foot.t, std::numbers::sqrt2 * limit * sigma)) {
        take(i);
        any = true;
      }
    }
  }
  return any ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace palpate
