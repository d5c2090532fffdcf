// What every model has in evidence: classes and free paths.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/modes/class_evidence.h"
#include "core/recognition/posterior/free_form.h"
#include "core/recognition/posterior/likelihood.h"

namespace palpate {

/// log of no evidence.
inline constexpr double kNoEvidence = -std::numeric_limits<double>::infinity();

/// The same of every model.
inline constexpr ByClass<double> kNoEvidences = [] {
  ByClass<double> none{};
  none.fill(kNoEvidence);
  return none;
}();

/// Evidence of every model. A class without one has no share in the posterior.
struct Evidences {
  ByClass<std::optional<ClassEvidence>> classes;
  /// Classes that nobody wants, by bit: they tell what others have at their limits, and have no
  /// share themselves.
  unsigned limits_only = 0;
  /// Modes that the prior has led to, of classes that have no evidence now; one of a class.
  std::vector<ClassEvidence> earlier_modes;
  /// Of the spline's other optimum, on the other side of c = 0 or of other arms, if that is a
  /// separate mode.
  std::optional<ClassEvidence> rival;
  /// If it is not: the share of the spline's mass about that optimum (slices.h).
  double rival_in_slices = 0.0;
  FreeForm free_form;
  /// log of the evidence of parts near a class, times what these are as probable beforehand as free
  /// paths (weigh/near_parts.h).
  double log_near = kNoEvidence;
  /// The same over the evidence of free paths, where all touches lie apart.
  double log_near_over_paths = kNoEvidence;
  /// log of the evidence of two edges with a fillet, as probable beforehand as free paths
  /// (weigh/edges_of_part.h).
  double log_edges = kNoEvidence;
  /// log of what each class has in nearly straight paths, where the line is in question
  /// (straight_paths.h): that or what lies about its fit, whichever is more.
  ByClass<double> log_straight = kNoEvidences;
  /// The same over the line's evidence.
  ByClass<double> log_over_line = kNoEvidences;
  /// What the evidences were computed with: the factor on noise variances, and each class placed on
  /// the reduced points, with its chi-square there; none where the evidence is not Laplace's.
  double inflation = 0.0;
  ByClass<std::optional<CanonicalFit>> on_reduced;
  ByClass<std::optional<double>> on_reduced_chi2;
  /// log of the factor that deviations shared by neighbours put on each class's evidence
  /// (weigh/shared_deviations.h).
  ByClass<double> log_shared{};
  /// With them, classes are more probable than free paths: it is such a deviation or another shape,
  /// at even odds.
  bool shared_or_other = false;
};

/// The evidence of free-form paths alone, of no class yet. `over_noise`: theirs where that has been
/// integrated over the noise before; may be nullptr.
Evidences evidences_of_paths(const SmoothModel& smooth, const Likelihood& likelihood,
                             const FreeForm* over_noise, WorkBudget& work);

/// log of the evidence of free-form paths.
double log_evidence_of_paths(const Likelihood& likelihood, const Evidences& evidences,
                             double smooth_chi2);

/// log of the evidence of "unclassified": free-form paths, parts near a class, and edges.
double log_evidence_of_unclassified(const Likelihood& likelihood, const Evidences& evidences,
                                    double smooth_chi2);

/// Places a class, fitted to the reduced points, on them, and adds its evidence by Laplace's
/// formula, if it has any.
void add_laplace_evidence(const ClassFit& on_reduced, const FitData& shared, Evidences* evidences,
                          WorkBudget& work);

/// Whether a class may be an answer.
inline bool is_wanted(const Evidences& evidences, CurveClass curve_class) {
  return (evidences.limits_only & class_bit(curve_class)) == 0;
}

/// The class's evidence, or else what is known of its modes; nullptr if nothing is.
const ClassEvidence* known_of(const Evidences& evidences, CurveClass curve_class);

/// Whether what a class has in nearly straight paths is known.
inline bool has_straight_paths(const Evidences& evidences, CurveClass curve_class) {
  return evidences.log_straight[curve_class] > kNoEvidence;
}

/// log of the evidence of a class that was fitted with `chi2`; -infinity if it has none.
double log_evidence(const Likelihood& likelihood, const Evidences& evidences,
                    CurveClass curve_class, double chi2);

inline double log_evidence(const Likelihood& likelihood, const Evidences& evidences,
                           const ClassFit& fit) {
  return log_evidence(likelihood, evidences, fit.curve_class, fit.chi2);
}

}  // namespace palpate
