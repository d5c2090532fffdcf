// A parabola sought beside the conic that fits.
#pragma once

#include "core/curves/algebraic/canonical_conic.h"
#include "core/recognition/fit/polynomial_fits.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Along the axis of a conic that fits and is nearly a parabola: the directions that the search
/// tries are 2.5 degrees apart, and legs that run along the axis more nearly than half of that lead
/// from each of them to another valley. `conic_chi2`: what the conic leaves.
void start_parabola_beside_conic(const ConicCoefficients& conic, double conic_chi2,
                                 const FitData& reduced, PolynomialFits* fits, WorkBudget& work);

}  // namespace palpate
