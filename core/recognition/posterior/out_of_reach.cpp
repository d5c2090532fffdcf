#include "core/recognition/posterior/out_of_reach.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "core/numerics/negligible.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/samples/stored_spikes.h"
#include "core/recognition/samples/tip_sides.h"

namespace palpate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How far from the curve a sample that is none of it may lie: no farther than from the nearest on
/// one side that is, and longer runs are no spikes.
double farthest_spike(std::span<const FitPoint> patch, std::size_t i) {
  double before = i < kLongestRunOfSpikes ? kInfinity : 0.0;
  double after = patch.size() - i <= kLongestRunOfSpikes ? kInfinity : 0.0;
  for (std::size_t k = 1; k <= kLongestRunOfSpikes; ++k) {
    before = i < k ? before : std::max(before, (patch[i].position - patch[i - k].position).norm());
    after = i + k >= patch.size()
                ? after
                : std::max(after, (patch[i].position - patch[i + k].position).norm());
  }
  return std::min(before, after);
}

}  // namespace

double out_of_reach(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths) {
  if (!noise_is_known_without_class(arcs, likelihood)) {
    return kInfinity;
  }
  const SmoothModel& smooth = arcs.smooth;
  const double noise = std::max(1.0, smooth.noise_ratio());
  double chi2 = noise * noise * static_cast<double>(residual_count(smooth.reduced)) +
                most_chi2_of_noise(arcs.data.points);
  const auto add = [&](double distance, const FitPoint& point) {
    chi2 += distance * distance * point.inverse_sigma * point.inverse_sigma;
  };
  for (const FitPoint& point : smooth.reduced.points) {
    add(tip_removal_error(point, noise), point);
  }
  for (std::size_t p = 0; p < arcs.data.patches.size(); ++p) {
    const auto patch = arcs.data.patch(p);
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::uint32_t nearest = smooth.nearest_reduced[arcs.data.patches[p].begin + i];
      const auto section = std::prev(
          std::upper_bound(smooth.sections.begin(), smooth.sections.end(), nearest,
                           [](std::uint32_t k, const ReducedSection& s) { return k < s.begin; }));
      if (section->kept) {
        add(farthest_spike(patch, i), patch[i]);
      }
    }
  }
  if (!std::isfinite(chi2)) {
    return kInfinity;
  }
  const double paths = log_evidence_of_unclassified(likelihood, of_paths, smooth.chi2);
  while (likelihood.log_evidence(smooth.chi2 + chi2, 0.0, 0.0) > paths - kNegligibleLogOdds) {
    chi2 *= 2.0;
  }
  return chi2;
}

}  // namespace palpate
