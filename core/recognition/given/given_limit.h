// Whether the points ask for the limit of a class, where it turns into another one.
#pragma once

#include "core/recognition/given/given_search.h"

namespace palpate {

/// Of the logarithm of the likelihood: far above what rounding makes of a sum of squares, and far
/// below what tells one curve from another.
inline constexpr double kAlike = 1e-6;

/// The misfit of the class, or of two parallel lines (parallel_lines.h), that the given one turns
/// into at its limit and that fits best; infinite if none does. Where it is no larger than that of
/// a curve in whose valley no descent has come to an end, nothing shows that the sum of squares has
/// a minimum before the limit. Else there is one somewhere.
double misfit_of_limit(CurveClass curve_class, const LocalPoints& local, const GivenNoise& noise);

}  // namespace palpate
