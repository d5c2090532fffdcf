// The classes' modes that their priors lead to, where these may hold more than those about the
// fits.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/evidences.h"

namespace palpate {

/// Of eight classes, so much less than the best, less than a thousandth is left: no probability
/// that is said to be more than 0.999 can be told from another (posterior_calibration_test).
inline constexpr double kUnseenLogOdds = 9.0;

/// log odds that a search must be able to gain: a factor of seven.
inline constexpr double kWorthAMode = 2.0;

/// Seeks them for every class of `fits` that may be seen beside the best, the best last: alone, it
/// has all of the mass at any mode. `log_of_free_form`: log evidence of "unclassified".
void add_prior_modes(const ClassFits& fits, const FitData& reduced, const Likelihood& likelihood,
                     double log_of_free_form, Evidences* evidences, WorkBudget& work);

}  // namespace palpate
