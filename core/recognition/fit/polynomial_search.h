// The polynomial classes on the reduced points: found by a search, or followed from earlier fits.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/polynomial_fits.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Exhaustive coarse search; then walks the valleys and refines the best of each class with coarse
/// effort. The cubics are left out if they are `out_of_reach` (as fit_classes). `line_fits`: that
/// is the limit of all, and no arms are sought.
PolynomialFits search_polynomials(const FitData& reduced, bool line_fits, double out_of_reach,
                                  WorkBudget& work);

/// The parabola alone, which the conics need at their limit.
PolynomialFits search_parabola(const FitData& reduced, WorkBudget& work);

/// Follows earlier fits without a search. Their t must be those of `reduced` (warm_start.h). Fits
/// that are far worse than the best stay as they are, with chi2 for the new points. `out_of_reach`:
/// as above, for all of them.
PolynomialFits follow_polynomials(const FitData& reduced, const PolynomialFits& starts,
                                  double out_of_reach, WorkBudget& work);

/// The last resort if nothing fits: refines thoroughly every seed of the arm models, whose sharp
/// bends make narrow valleys, and the best seeds of the others.
void refine_every_seed(const FitData& reduced, double out_of_reach, PolynomialFits* fits,
                       WorkBudget& work);

}  // namespace palpate
