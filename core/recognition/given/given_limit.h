// Whether the points ask for the limit of a class, where it turns into another one.
#pragma once

#include "core/recognition/given/given_search.h"

namespace palpate {

/// True if a class that is the limit of the given one fits the points no worse than a curve of
/// `misfit` in whose valley no descent has come to an end: then nothing shows that the sum of
/// squares has a minimum before the limit. Else there is one somewhere, which the search has not
/// reached.
bool limit_fits_no_worse(CurveClass curve_class, double misfit, const LocalPoints& local,
                         const GivenNoise& noise);

}  // namespace palpate
