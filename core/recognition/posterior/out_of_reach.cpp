#include "core/recognition/posterior/out_of_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/local/spikes/jumps.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/samples/tips/tip_sides.h"

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

double chi2_of_distance(double distance, const FitPoint& point) {
  return distance * distance * point.inverse_sigma * point.inverse_sigma;
}

/// What noise, form error and errors of directions leave on the reduced points, at most.
double most_of_touches(const Arcs& arcs, const FitData& touches) {
  const double noise = std::max(1.0, arcs.smooth.noise_ratio());
  double chi2 = noise * noise * static_cast<double>(residual_count(touches)) +
                most_chi2_of_noise(arcs.data.points);
  for (const FitPoint& point : touches.points) {
    chi2 += chi2_of_distance(tip_removal_error(point, noise), point);
  }
  return chi2;
}

/// What spikes among the samples that are kept as they are leave, at most.
double most_of_spikes(const Arcs& arcs) {
  const SmoothModel& smooth = arcs.smooth;
  double chi2 = 0.0;
  auto section = smooth.sections.begin();
  for (std::size_t p = 0; p < arcs.data.patches.size(); ++p) {
    const auto patch = arcs.data.patch(p);
    for (std::size_t i = 0; i < patch.size(); ++i) {
      while (smooth.nearest_reduced[arcs.data.patches[p].begin + i] >= section->end) {
        ++section;
      }
      if (section->kept) {
        chi2 += chi2_of_distance(farthest_spike(patch, i), patch[i]);
      }
    }
  }
  return chi2;
}

/// From `chi2` on, what is hopeless beside a model of that evidence, to a factor of two.
double hopeless_from(double chi2, const Arcs& arcs, const Likelihood& likelihood,
                     double log_evidence) {
  if (!std::isfinite(chi2)) {
    return kInfinity;
  }
  while (likelihood.log_evidence(arcs.smooth.chi2 + chi2, 0.0, 0.0) >
         log_evidence - kNegligibleLogOdds) {
    chi2 *= 2.0;
  }
  return chi2;
}

}  // namespace

double out_of_reach(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths) {
  if (!noise_is_known_without_class(arcs, likelihood)) {
    return kInfinity;
  }
  return hopeless_from(most_of_touches(arcs, arcs.smooth.reduced) + most_of_spikes(arcs), arcs,
                       likelihood,
                       log_evidence_of_unclassified(likelihood, of_paths, arcs.smooth.chi2));
}

double out_of_reach(const Arcs& arcs, const FitData& touches, const Likelihood& likelihood,
                    double log_evidence) {
  return noise_is_known_without_class(arcs, likelihood)
             ? hopeless_from(most_of_touches(arcs, touches), arcs, likelihood, log_evidence)
             : kInfinity;
}

}  // namespace palpate
