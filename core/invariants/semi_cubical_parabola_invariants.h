// The semi-cubical parabola (t^2, a t^3 + b t^2): invariants Iscp1 = a^2 (43) and Iscp2 = b (44),
// whose slope two points determine.
#pragma once

#include <cmath>

#include "core/invariants/canonical_angle.h"
#include "core/invariants/canonical_point.h"
#include "core/invariants/pair_solution.h"

namespace palpate {

/// Iscp1 = a^2, (43) [1/m]. The sign of kappa cosine is part of it, so that the direction of travel
/// does not matter. Negative: the frame must be turned by pi, or the class is another.
template <typename T>
T semi_cubical_parabola_a_squared(const CanonicalPoint<T>& p) {
  const T c2 = p.cosine * p.cosine;
  return -8.0 * p.kappa * p.kappa * p.kappa / (9.0 * c2 * c2 * p.jerk);
}

/// Iscp2 = b, (44).
template <typename T>
T semi_cubical_parabola_b(const CanonicalPoint<T>& p) {
  return (p.sine + p.kappa * p.kappa / p.jerk) / p.cosine;
}

/// "Iscp2 is the same at both points" for the canonical tangent angle of point 1; see
/// cubical_parabola_quadratic for the arguments.
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

/// Up to two (a, b), a > 0, at which the second invariant agrees exactly; the first one, or a third
/// point, chooses.
PairSolutions semi_cubical_parabola_pair(const MeasuredGeometry& point1,
                                         const MeasuredGeometry& point2);

}  // namespace palpate
