// How much shared deviations of neighbouring points add to the evidence of a class.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/modes/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// log of (evidence if such deviations are as probable a priori as none) / (evidence with noise
/// alone). Arguments as coherent_moment(), with two differences: shape and pose have the prior of
/// their class, linear about `evidence`, and the drift's deviation is uniform in its logarithm from
/// sigma / sqrt(n) to sigma sqrt(n), n samples, the same for all classes; neither it nor the
/// offset's is more than `most` sigma. nullopt if coherent_moment() has none.
std::optional<double> log_coherent_gain(const CanonicalFit& placed, const ClassEvidence& evidence,
                                        const FitData& reduced, const Likelihood& likelihood,
                                        double sigma, double scatter, double most,
                                        WorkBudget& work);

}  // namespace palpate
