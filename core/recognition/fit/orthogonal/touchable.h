// Tests whether a probe could have touched a fitted curve at the points.
#pragma once

#include <span>

#include "core/recognition/fit/orthogonal/implicit_fit.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Positive for ellipses, negative for hyperbolas; unit-norm coefficients.
inline double discriminant(const ConicCoefficients& q) { return 4.0 * q[0] * q[2] - q[1] * q[1]; }

/// The centre of an ellipse or hyperbola; not finite for a parabola.
inline Vec2 centre_of(const ConicCoefficients& q) {
  return Vec2(q[1] * q[4] - 2.0 * q[2] * q[3], q[1] * q[3] - 2.0 * q[0] * q[4]) / discriminant(q);
}

/// True if a probe could have touched the conic at these points: one branch, with each patch on one
/// side of it. A thin ellipse, or the two branches of a flat hyperbola, can "explain" straight
/// noisy points if neighbours lie on opposite sides. Its direction of travel then flips from point
/// to point against that of the patch. (A probe may turn back along the curve.) The fit must be one
/// to these points.
bool is_touchable(const ImplicitFit& fit, const FitData& data);

/// The same for a polynomial curve: its parameter must run one way along each patch. Compares
/// samples half a patch apart, whose order noise does not reverse. Where a patch is too short for
/// its noise to tell, neighbours must not go to and fro between strands of the curve. Where a curve
/// crosses itself, and beside a cusp, noise puts feet on either strand: those that may as well be
/// on that of most of their patch count as there, for this test and the next. The fit of a given
/// class (given/placed/stroke_feet.h) puts every sample of a stroke on a branch, by the way that
/// the probe went; here a fitted curve is only kept or excluded, for which that is enough.
bool is_touchable(const PolynomialFit& fit, const FitData& data);

/// Whether between two of its points a patch leaves out more of the curve than it is long itself: a
/// cubic that crosses itself fits two edges, with a loop between them that no sample is on. By less
/// than half a turn it leaves out what a bend does. Nothing is said of two samples, and of tips'
/// centres: between two walls they go from one to the other.
bool leaps(const PolynomialFit& fit, const FitData& data);

}  // namespace palpate
