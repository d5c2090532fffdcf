// What neighbours along a stroke err alike by, counted in the fit of a given class.
#pragma once

#include <span>

#include "core/recognition/given/given_class.h"
#include "core/recognition/given/given_point.h"
#include "core/recognition/smooth/residual_correlation.h"

namespace palpate {

/// Multiplies the covariance of a fit by the correlation time of its residuals along the strokes: n
/// neighbours that err alike are worth so many fewer independent ones. Part and probe are not asked
/// which of them it is. Of a stated noise only what the residuals show is known to be shared.
/// Points that belong to no stroke have no neighbours, those set aside do not count. Returns the
/// correlation [samples, m]; white, and nothing is changed, if the fit has no curve. `points`:
/// those of the fit, in their order. O(points * time).
ResidualCorrelation count_correlation(std::span<const GivenPoint> points, GivenFit* fit);

}  // namespace palpate
