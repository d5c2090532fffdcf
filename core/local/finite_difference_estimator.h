// Finite differences (51) of the tangent angle, as in section 5.1.
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

/// Estimate at the middle of five points p0 ... p4 of the window. The tangent angle at p1, p2 and
/// p3 is that of the chord between the two neighbours. Arc lengths are chords. kappa and kappa_s
/// are divided differences of the angle; for evenly spaced points these are (51). With the spacing
/// d, the bias is d^2 kappa_ss / 3 for kappa and of order d^2 for kappa_s. `sigma_m`: noise [m]; 0
/// = the noise of a jet fitted to the window. O(1) if the noise is given, otherwise O(samples).
/// Does not allocate.
LocalResult finite_difference_estimate(std::span<const Vec2> samples, double sigma_m = 0.0);

}  // namespace palpate
