// Curvature of the circle through three points (Calabi et al.), and its difference quotient
// (Boutin).
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

/// Estimate at the middle of five points p0 ... p4 of the window. kappa is the curvature of the
/// circle through p1, p2, p3; the tangent is that circle's at p2; and
///   kappa_s = 3 (kappa_3 - kappa_1) / (2 a + 2 b + d + g),
/// with kappa_1 from p0 p1 p2 and kappa_3 from p2 p3 p4, a = |p1 p2|, b = |p2 p3|, d = |p0 p1|, g =
/// |p3 p4|. The curvature of a circle belongs to the mean arc length of its three points, and the
/// quotient is taken over those means.
///
/// Bias of kappa: (b - a) kappa_s / 3, plus terms of second order in the spacing. Bias of kappa_s:
/// of second order, if the spacing is even. `sigma_m`: noise [m]; 0 = the noise of a jet fitted to
/// the window. O(1) if the noise is given, otherwise O(samples). Does not allocate.
LocalResult circle_estimate(std::span<const Vec2> samples, double sigma_m = 0.0);

}  // namespace palpate
