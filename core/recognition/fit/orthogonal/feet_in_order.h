// The feet of strokes near a sharp bend, put in their order along the curve.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// `fit` with the feet of each stroke that runs back and forth (is_touchable) on one arm of the
/// bend, or on one and then on the other. Where the arms are no farther apart than noise, the
/// nearest feet are now on this one and now on that. Not refined; unchanged where no order of that
/// kind is one way along the curve. Neither chi2 nor coefficients change.
PolynomialFit with_feet_in_order(PolynomialFit fit, const FitData& data, WorkBudget& work);

}  // namespace palpate
