// The effect of a stated form error on the information of many samples.
#pragma once

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Upper bound on the variance that form error adds to a combination of the points' residuals, in
/// units of their noise variance: deviation^2 sum 1 / sigma^2. `deviation`: its standard deviation,
/// normalised; the form error may have any correlation along the arc. 0 without form error. See
/// core/README.md, "Stated form error".
double coherent_variance(const FitData& data, double deviation);

}  // namespace palpate
