// The probability of each class, given all that was touched.
#pragma once

#include <array>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/evidences.h"
#include "core/recognition/posterior/likelihood.h"

namespace palpate {

/// Indexed by CurveClass; entry 0 is "unclassified".
using ClassProbabilities = ByClass<double>;

/// The evidences with quadrature for the classes whose share matters, if there are several, and for
/// the spline's other mode. `margin`: log odds below which the best is not RECOGNIZED.
Evidences integrated(Evidences evidences, const ClassFits& fits, const ClassFits& on_reduced,
                     double smooth_chi2, const FitData& reduced, const Likelihood& likelihood,
                     double margin, WorkBudget& work);

/// Posterior probabilities, with equal priors for all classes. If a conic has no optimum on its own
/// side of the parabola, it gets the mass that the optimum on the other side leaves there.
ClassProbabilities probabilities_of(const ClassFits& fits, double smooth_chi2,
                                    const Likelihood& likelihood, const Evidences& evidences);

/// log odds of "unclassified" over the strongest class, if all of that class's prior were at the
/// shape that fits. With few data a probability depends mostly on the priors of shapes; only if
/// this margin is large do the data themselves exclude the classes. A class whose evidence was not
/// told counts with all that its chi-square lets it have.
double margin_of_unclassified(const ClassFits& fits, double smooth_chi2,
                              const Likelihood& likelihood, const Evidences& evidences);

/// The share of the spline's posterior in its other mode, separate or within the slices.
double rival_share(const ClassFits& fits, const Likelihood& likelihood, const Evidences& evidences);

}  // namespace palpate
