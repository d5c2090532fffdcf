// Are residuals noise, or do neighbours err together?
#pragma once

#include <span>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Form error of a part and drift of a probe are correlated along the arc: n such residuals are
/// worth only n / time independent ones.
struct ResidualCorrelation {
  double time = 1.0;    ///< integrated autocorrelation time, in samples; 1 = white
  double length = 0.0;  ///< arc over which residuals are correlated, units of the points; 0 = white
};

/// From the normalised residuals of all points, patch by patch in order. White unless the lag-one
/// correlation exceeds what independent residuals show once in a thousand cases. O(points * time).
ResidualCorrelation correlation_of(const FitData& data, std::span<const double> residuals);

}  // namespace palpate
