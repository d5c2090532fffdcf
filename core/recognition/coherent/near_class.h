// How much evidence there is for a part that is nearly, but visibly not, of a class.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/modes/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// log of (evidence of smooth deviations of the part from the class / evidence of the class). All
/// sizes from a quarter to four millionths of the half extent are equally probable in their
/// logarithm, and so are three lengths; sizes that the data would hardly tell from none do not
/// count (core/README.md, "The posterior"). `placed`: the class on `reduced`, with noise alone;
/// `sigma`: noise of the typical point, normalised; `scatter`: chi-square of all samples about the
/// reduced points; `least_size`: smaller deviations do not count either [half extents]; `least`:
/// less need not be computed. nullopt if there are too few points to tell a deviation, or normals
/// at touches. O(points).
std::optional<double> log_gain_near_class(const CanonicalFit& placed, const ClassEvidence& evidence,
                                          const FitData& reduced, const Likelihood& likelihood,
                                          double sigma, double scatter, double least_size,
                                          double least, WorkBudget& work);

}  // namespace palpate
