// Tests whether residuals are white noise or correlated between neighbours.
#pragma once

#include <span>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Correlation along the arc, from form error of the part or drift of the probe: n such residuals
/// are worth n / time independent ones.
struct ResidualCorrelation {
  double time = 1.0;    ///< integrated autocorrelation time, in samples; 1 = white
  double length = 0.0;  ///< arc length of the correlation, in units of the points; 0 = white
};

/// `residuals`: normalised, of all points, patch by patch in order. The result is white unless the
/// lag-one correlation is larger than independent residuals show once in a thousand cases. O(points
/// * time).
ResidualCorrelation correlation_of(const FitData& data, std::span<const double> residuals);

}  // namespace palpate
