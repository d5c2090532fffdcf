#include "core/recognition/posterior/out_of_reach.h"

#include <algorithm>
#include <limits>

#include "core/numerics/negligible.h"
#include "core/recognition/posterior/likelihood_of.h"

namespace palpate {

double out_of_reach(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths) {
  const SmoothModel& smooth = arcs.smooth;
  const bool follows_all =
      fits_well(smooth.chi2, static_cast<std::size_t>(std::max(smooth.dof(), 0))) &&
      std::none_of(smooth.sections.begin(), smooth.sections.end(),
                   [](const ReducedSection& section) { return section.kept; });
  if (!follows_all || !tells_noise(arcs, likelihood) || has_tips(arcs.data.points)) {
    return std::numeric_limits<double>::infinity();
  }
  double information = 0.0;
  for (const FitPoint& point : arcs.data.points) {
    information += point.inverse_sigma * point.inverse_sigma;
  }
  double chi2 = static_cast<double>(residual_count(smooth.reduced)) +
                kLargestNoise * kLargestNoise * information;
  const double paths = log_evidence_of_free_form(likelihood, of_paths, smooth.chi2);
  while (likelihood.log_evidence(smooth.chi2 + chi2, 0.0, 0.0) > paths - kNegligibleLogOdds) {
    chi2 *= 2.0;
  }
  return chi2;
}

}  // namespace palpate
