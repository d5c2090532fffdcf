// Calabi et al.'s curvature of the circle through three points, and Boutin's difference quotient
// of it.
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

/// Five points of the window p0 ... p4: kappa is that of the circle through p1, p2, p3, the tangent
/// that circle's at p2, and
///   kappa_s = 3 (kappa_3 - kappa_1) / (2 a + 2 b + d + g),
/// kappa_1 of p0 p1 p2 and kappa_3 of p2 p3 p4, with a = |p1 p2|, b = |p2 p3|, d = |p0 p1|,
/// g = |p3 p4|: a circle's curvature belongs to the mean arc length of its three points, and the
/// quotient is of those means. Bias: (b - a) kappa_s / 3 and of second order in the spacing in
/// kappa, of second order in kappa_s where the spacing is even. `sigma_m`: noise, 0 = that of the
/// window's jet. Cost O(1) with the noise given, else O(samples); no allocation.
LocalResult circle_estimate(std::span<const Vec2> samples, double sigma_m = 0.0);

}  // namespace palpate
