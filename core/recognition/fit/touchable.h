// Whether a fitted curve is one that a probe could have touched at the points.
#pragma once

#include "core/recognition/fit/implicit_fit.h"
#include "core/recognition/fit/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Positive for ellipses, negative for hyperbolas; unit-norm coefficients.
inline double discriminant(const ConicCoefficients& q) { return 4.0 * q[0] * q[2] - q[1] * q[1]; }

/// Whether a conic is one that a probe could have touched at these points: one branch, each patch
/// on one side of it. A thin ellipse, or the two branches of a flat hyperbola, "explains" straight
/// noisy points by letting neighbours lie on opposite sides: its direction of travel then flips
/// against the patch's own from point to point. The fit must be one to these points.
bool is_touchable(const ImplicitFit& fit, const FitData& data);

/// The same for a polynomial curve: the curve parameter runs one way along a patch. Samples half a
/// patch apart are compared, whose order noise does not turn round.
bool is_touchable(const PolynomialFit& fit, const FitData& data);

}  // namespace palpate
