#include "core/recognition/posterior/evidences.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/probability/log_add.h"

namespace palpate {
namespace {

/// With fewer degrees of freedom the sections tell the noise to less than a tenth, by which what
/// the prior leaves of ten coordinates is off by a factor of e: then paths are integrated over it.
constexpr int kDegreesThatTellNoise = 50;

}  // namespace

Evidences evidences_of_paths(const SmoothModel& smooth, const Likelihood& likelihood,
                             const FreeForm* over_noise, WorkBudget& work) {
  Evidences evidences;
  evidences.inflation = likelihood.inflation();
  const bool is_told = likelihood.sigma_known || smooth.dof() >= kDegreesThatTellNoise;
  evidences.free_form = is_told || likelihood.coherent_variance > 0.0
                            ? free_form(smooth, evidences.inflation, work)
                        : over_noise != nullptr ? *over_noise
                                                : free_form_over_noise(smooth, likelihood, work);
  return evidences;
}

double log_evidence_of_paths(const Likelihood& likelihood, const Evidences& evidences,
                             double smooth_chi2) {
  const FreeForm& paths = evidences.free_form;
  if (paths.log_over_noise) {
    return *paths.log_over_noise + paths.log_occam;
  }
  return likelihood.log_evidence(smooth_chi2 + likelihood.inflation() * paths.chi2, paths.log_occam,
                                 paths.determined);
}

double log_evidence_of_unclassified(const Likelihood& likelihood, const Evidences& evidences,
                                    double smooth_chi2) {
  const double log_paths = log_evidence_of_paths(likelihood, evidences, smooth_chi2);
  return log_add(log_add(log_paths, evidences.log_near), evidences.log_edges);
}

void add_laplace_evidence(const ClassFit& on_reduced, const FitData& shared, Evidences* evidences,
                          WorkBudget& work) {
  const FitData& reduced = points_of(on_reduced, shared);
  const CurveClass i = on_reduced.curve_class;
  evidences->on_reduced_chi2[i] = on_reduced.chi2;
  evidences->classes[i].reset();
  if ((evidences->on_reduced[i] = to_canonical(on_reduced, reduced))) {
    evidences->classes[i] =
        evidence_of(*evidences->on_reduced[i], reduced, evidences->inflation, work);
  }
}

const ClassEvidence* known_of(const Evidences& evidences, CurveClass curve_class) {
  if (const auto& evidence = evidences.classes[curve_class]) {
    return &*evidence;
  }
  const auto earlier =
      std::find_if(evidences.earlier_modes.begin(), evidences.earlier_modes.end(),
                   [&](const ClassEvidence& e) { return e.touch.curve_class == curve_class; });
  return earlier != evidences.earlier_modes.end() ? &*earlier : nullptr;
}

double log_evidence(const Likelihood& likelihood, const Evidences& evidences,
                    CurveClass curve_class, double chi2) {
  const auto& evidence = evidences.classes[curve_class];
  double about_fit = kNoEvidence;
  if (evidence && std::isfinite(chi2)) {
    // Of a fit that a mode of the prior leaves behind: where residuals tell the noise, chi-square
    // that falls by so much is worth less than half of it.
    const double fall = fall_to_mode(*evidence);
    about_fit = likelihood.log_evidence(std::max(chi2 - evidences.inflation * fall, 0.0),
                                        evidence->log_occam - 0.5 * fall, evidence->determined);
  }
  return std::max(about_fit, evidences.log_straight[curve_class]) +
         evidences.log_shared[curve_class];
}

}  // namespace palpate
