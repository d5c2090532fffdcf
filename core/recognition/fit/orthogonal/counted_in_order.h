// What a polynomial curve leaves of strokes whose samples follow each other along it.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// `fit` with the feet of each stroke that jumps between branches (way_along.h) in the likeliest
/// order in which a probe can have gone there, and with the chi-square that it has with these. Each
/// sample on the nearest of several branches, a curve laid to and fro over a stroke that is not
/// much longer than its noise would explain the noise. Round tips are left where they are. Not
/// refined. O(points), many times as much where a stroke jumps.
PolynomialFit counted_in_order(PolynomialFit fit, const FitData& data, WorkBudget& work);

}  // namespace palpate
