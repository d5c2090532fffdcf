// The finite differences (51) of the tangent angle, as in section 5.1.
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

/// Five points of the window p0 ... p4; the tangent angle at p1, p2, p3 is that of the chord
/// between its neighbours, arc lengths are chords, and kappa and kappa_s are the divided
/// differences of the angle, which are (51) where the points are evenly spaced. With d the
/// spacing, the bias is d^2 kappa_ss / 3 in kappa and of order d^2 in kappa_s. `sigma_m`: noise, 0
/// = that of the window's jet. Cost O(1) with the noise given, else O(samples); no allocation.
LocalResult finite_difference_estimate(std::span<const Vec2> samples, double sigma_m = 0.0);

}  // namespace palpate
