// Evidence of a class if its residuals may be a coherent deviation as well as noise.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/modes/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// log of the evidence, comparable with Likelihood::log_evidence, integrated over amplitude and
/// length of a deviation that is coherent along the curve (Markov's law). A priori the probability
/// of no deviation at all is 1/2. A smooth difference between two curves may be such a deviation:
/// the data then separate them no better than they show the deviation to be small.
///
/// `placed`: the class on `reduced`. `chi2`: its chi-square on all `samples` points; `scatter`: the
/// part of it that these points have about the reduced ones, the same for every class. `sigma`:
/// noise of the typical point, normalised. O(points).
double log_coherent_evidence(const Likelihood& likelihood, const ClassEvidence& evidence,
                             const CanonicalFit& placed, const FitData& reduced, double sigma,
                             double samples, double chi2, double scatter, WorkBudget& work);

}  // namespace palpate
