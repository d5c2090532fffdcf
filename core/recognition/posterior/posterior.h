// How probable each class is, given all that was touched.
#pragma once

#include <array>
#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/class_evidence.h"
#include "core/recognition/posterior/free_form.h"
#include "core/recognition/posterior/likelihood.h"

namespace palpate {

/// Indexed by CurveClass; entry 0 is "unclassified".
using ClassProbabilities = std::array<double, 9>;

/// What every model's prior leaves of its likelihood. A class without has no share in the
/// posterior.
struct Evidences {
  std::array<std::optional<ClassEvidence>, 9> classes;
  /// Of the spline's optimum on the other side of c = 0, where that is a mode of its own.
  std::optional<ClassEvidence> rival;
  FreeForm free_form;
  /// What it was taken with: noise variances counted so many times, and each class as placed on the
  /// reduced points, at this chi-square of theirs.
  double inflation = 0.0;
  std::array<std::optional<CanonicalFit>, 9> on_reduced;
  std::array<double, 9> on_reduced_chi2{};
  /// log of what deviations that neighbours share give the classes' evidence, or take
  /// (weigh/shared_deviations.h).
  std::array<double, 9> log_shared{};
  /// With them classes have more than free paths: it is such a deviation, or another shape.
  bool shared_or_other = false;
};

/// Of no class yet, but of free-form paths.
Evidences evidences_of_paths(const SmoothModel& smooth, const Likelihood& likelihood,
                             WorkBudget& work);

/// log of the evidence of free-form paths.
double log_evidence_of_free_form(const Likelihood& likelihood, const Evidences& evidences,
                                 double smooth_chi2);

/// log of the evidence of a class that was fitted with `chi2`; -infinity where it has none.
double log_evidence(const Likelihood& likelihood, const Evidences& evidences,
                    CurveClass curve_class, double chi2);

/// Evidence of the classes fitted to the reduced points, by Laplace's formula. Those that cannot
/// come within odds of a millionth of the best have none. `fits`: with chi-squares of all points.
/// `before`: of the same points; what has not changed since is taken from it.
Evidences evidences_of(const ClassFits& fits, const ClassFits& on_reduced,
                       const SmoothModel& smooth, const FitData& reduced,
                       const Likelihood& likelihood, Evidences before, WorkBudget& work);

/// The same with quadrature for the classes whose share is not negligible, where there are several;
/// and the spline's other mode. `margin`: log odds that keep the best from being RECOGNIZED.
Evidences integrated(Evidences evidences, const ClassFits& fits, const ClassFits& on_reduced,
                     double smooth_chi2, const FitData& reduced, const Likelihood& likelihood,
                     double margin, WorkBudget& work);

/// Posterior probabilities, all classes alike probable before. A conic that has no optimum on its
/// own side of the parabola has the mass that the other side's optimum leaves there.
ClassProbabilities probabilities_of(const ClassFits& fits, double smooth_chi2,
                                    const Likelihood& likelihood, const Evidences& evidences);

/// log odds of "unclassified" over the class that speaks most against it, if all of that class's
/// prior were at the shape that fits. Few data leave most of a probability to the priors of shapes;
/// only beyond this do the data exclude the classes by themselves.
double margin_of_unclassified(const ClassFits& fits, double smooth_chi2,
                              const Likelihood& likelihood, const Evidences& evidences);

/// The share of the spline's posterior that its mode on the other side of c = 0 has.
double rival_share(const ClassFits& fits, const Likelihood& likelihood, const Evidences& evidences);

}  // namespace palpate
