#include "core/recognition/coherent/markov_drift.h"

#include "core/recognition/posterior/runs_along.h"

namespace palpate {

std::vector<DriftStep> drift_steps(const CanonicalFit& placed, const FitData& reduced,
                                   double sigma) {
  const Runs runs = runs_along(placed, reduced.patches);
  std::vector<DriftStep> steps;
  steps.reserve(runs.order.size());
  for (const PatchSpan& run : runs.spans) {
    for (std::size_t k = run.begin; k < run.end; ++k) {
      const std::size_t i = runs.order[k];
      const FitPoint& point = reduced.points[i];
      const double deviation = 1.0 / (point.inverse_sigma * sigma);
      DriftStep step{i, placed.points[i].residual * deviation, deviation * deviation};
      if (k > run.begin) {
        step.from_last = (point.position - reduced.points[runs.order[k - 1]].position).norm();
      }
      steps.push_back(step);
    }
  }
  return steps;
}

}  // namespace palpate
