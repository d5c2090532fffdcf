#include "core/recognition/posterior/evidences.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/log_add.h"

namespace palpate {

Evidences evidences_of_paths(const SmoothModel& smooth, const Likelihood& likelihood,
                             WorkBudget& work) {
  Evidences evidences;
  evidences.inflation = likelihood.inflation();
  evidences.free_form = free_form(smooth, evidences.inflation, work);
  return evidences;
}

double log_evidence_of_unclassified(const Likelihood& likelihood, const Evidences& evidences,
                                    double smooth_chi2) {
  const FreeForm& paths = evidences.free_form;
  const double log_paths = likelihood.log_evidence(
      smooth_chi2 + likelihood.inflation() * paths.chi2, paths.log_occam, paths.determined);
  return log_add(log_paths, evidences.log_near);
}

const ClassEvidence* known_of(const Evidences& evidences, CurveClass curve_class) {
  if (const auto& evidence = evidences.classes[static_cast<std::size_t>(curve_class)]) {
    return &*evidence;
  }
  const auto known =
      std::find_if(evidences.known.begin(), evidences.known.end(),
                   [&](const ClassEvidence& e) { return e.touch.curve_class == curve_class; });
  return known == evidences.known.end() ? nullptr : &*known;
}

double log_evidence(const Likelihood& likelihood, const Evidences& evidences,
                    CurveClass curve_class, double chi2) {
  const auto i = static_cast<std::size_t>(curve_class);
  const auto& evidence = evidences.classes[i];
  const double about_fit =
      evidence && std::isfinite(chi2)
          ? likelihood.log_evidence(chi2, evidence->log_occam, evidence->determined)
          : kNoEvidence;
  return std::max(about_fit, evidences.log_straight[i]) + evidences.log_shared[i];
}

}  // namespace palpate
