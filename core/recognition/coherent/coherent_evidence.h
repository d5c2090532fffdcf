// The evidence of a class where what it leaves may be coherent deviation as well as noise.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Integral over amplitude and length of a deviation that is coherent along the curve (Markov's
/// law), none being as probable beforehand as any: log of the evidence, as Likelihood::log_evidence
/// has it without such. `placed`: the class on `reduced`; `chi2`: its chi-square on all `samples`
/// points, `scatter` what these leave about the reduced ones whatever the class. `sigma`: of the
/// typical point. What two curves differ by smoothly, such a deviation may
/// be: data then tell them apart no better than they tell the deviation to be small. O(points).
double log_coherent_evidence(const Likelihood& likelihood, const ClassEvidence& evidence,
                             const CanonicalFit& placed, const FitData& reduced, double sigma,
                             double samples, double chi2, double scatter, WorkBudget& work);

}  // namespace palpate
