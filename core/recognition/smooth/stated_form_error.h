// What a part's stated form error leaves of what many samples can tell.
#pragma once

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The largest variance that a form error of standard deviation `deviation` (normalised), smooth
/// along the arc in whatever way, adds to a combination of the points' residuals, beside that of
/// their noise, 1: deviation^2 sum 1 / sigma^2. 0 without form error. See core/README.md, "Stated
/// form error".
double coherent_variance(const FitData& data, double deviation);

}  // namespace palpate
