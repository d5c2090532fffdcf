// The cubical parabola y = a x^3 + c x: its invariants Icp1 = a (39) and Icp2 = c (40). Two points
// determine the slope that they need. Erratum: section 5.2 calls the second parameter b; c is
// meant.
#pragma once

#include <cmath>

#include "core/invariants/canonical_angle.h"
#include "core/invariants/canonical_point.h"
#include "core/invariants/pair_solution.h"

namespace palpate {

/// Icp1, (39) [1/m^2]. Infinite if the canonical tangent is vertical, which it is nowhere on a
/// cubical parabola.
template <typename T>
T cubical_parabola_a(const CanonicalPoint<T>& p) {
  const T c2 = p.cosine * p.cosine;
  return p.jerk / (6.0 * c2 * c2 * p.cosine);
}

/// Icp2, (40) [1].
template <typename T>
T cubical_parabola_c(const CanonicalPoint<T>& p) {
  return (p.sine - p.kappa * p.kappa / (2.0 * p.jerk)) / p.cosine;
}

/// The condition that Icp2 is equal at both points, (41) and (42), for the canonical tangent angle
/// of point 1. `rotation`: tangent angle of point 2 minus that of point 1, both in the direction of
/// travel. [rad]
template <typename T>
AngleQuadratic<T> cubical_parabola_quadratic(const T& kappa1, const T& kappa_s1, const T& kappa2,
                                             const T& kappa_s2, const T& rotation) {
  using std::cos;
  using std::sin;
  const T s = sin(rotation);
  const T c = cos(rotation);
  const T k1 = kappa1 * kappa1;
  const T k2 = kappa2 * kappa2;
  // d4, d3 and d0 of (42) times cos^2(rotation).
  const T inflow = 3.0 * k2 * c - kappa_s2 * s;
  const T across = 3.0 * k2 * s + kappa_s2 * c;
  return {5.0 * k1 * s * inflow, 2.0 * s * (kappa_s1 * inflow + 2.0 * k1 * across),
          kappa_s1 * (k2 * (5.0 * s * s - c * c) + 2.0 * kappa_s2 * s * c) + k1 * c * across};
}

/// Up to two solutions (a, c) for which the second invariant agrees exactly. The first invariant,
/// or a third point, decides between them.
PairSolutions cubical_parabola_pair(const MeasuredGeometry& point1, const MeasuredGeometry& point2);

}  // namespace palpate
