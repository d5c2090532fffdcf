// What deviations that neighbours share add to the evidence of a class.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// log of the evidence where such deviations are as probable as none beforehand, over that of noise
/// alone. Arguments as coherent_moment()'s; but of shape and pose that is expected which the prior
/// of the class says about `evidence`, and of a drift's deviation that it is any alike, in its
/// logarithm, from where the mean of all samples hides it to where it is to the noise what that is
/// to the mean: the same for all classes. nullopt where coherent_moment() has none.
std::optional<double> log_coherent_gain(const CanonicalFit& placed, const ClassEvidence& evidence,
                                        const FitData& reduced, const Likelihood& likelihood,
                                        double sigma, double scatter, WorkBudget& work);

}  // namespace palpate
