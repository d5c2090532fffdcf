// The semi-cubical parabola (t^2, a t^3 + b t^2): its invariants Iscp1 = a^2 (43) and Iscp2 = b
// (44). Two points determine the slope that they need.
#pragma once

#include <cmath>

#include "core/invariants/canonical_angle.h"
#include "core/invariants/canonical_point.h"
#include "core/invariants/pair_solution.h"

namespace palpate {

/// Iscp1 = a^2, (43) [1/m]. It contains the sign of kappa cosine, so the direction of travel does
/// not matter. Negative: the frame must be turned by pi, or the curve is of another class.
template <typename T>
T semi_cubical_parabola_a_squared(const CanonicalPoint<T>& p) {
  const T c2 = p.cosine * p.cosine;
  return -8.0 * p.kappa * p.kappa * p.kappa / (9.0 * c2 * c2 * p.jerk);
}

/// Iscp2 = b, (44) [1].
template <typename T>
T semi_cubical_parabola_b(const CanonicalPoint<T>& p) {
  return (p.sine + p.kappa * p.kappa / p.jerk) / p.cosine;
}

/// The condition that Iscp2 is equal at both points, for the canonical tangent angle of point 1.
/// Arguments as for cubical_parabola_quadratic.
template <typename T>
AngleQuadratic<T> semi_cubical_parabola_quadratic(const T& kappa1, const T& kappa_s1,
                                                  const T& kappa2, const T& kappa_s2,
                                                  const T& rotation) {
  using std::cos;
  using std::sin;
  const T s = sin(rotation);
  const T c = cos(rotation);
  const T k1 = kappa1 * kappa1;
  const T k2 = kappa2 * kappa2;
  // e4, e3 and e0 times cos^2(rotation).
  const T outflow = kappa_s2 * s - 3.0 * k2 * c;
  const T across = kappa_s2 * c + 3.0 * k2 * s;
  return {4.0 * k1 * s * outflow, s * (kappa_s1 * outflow - 5.0 * k1 * across),
          k1 * c * across - kappa_s1 * (kappa_s2 * s * c + k2 * (c * c + 4.0 * s * s))};
}

/// Up to two solutions (a, b), a > 0, for which the second invariant agrees exactly. The first
/// invariant, or a third point, decides between them.
PairSolutions semi_cubical_parabola_pair(const MeasuredGeometry& point1,
                                         const MeasuredGeometry& point2);

}  // namespace palpate
