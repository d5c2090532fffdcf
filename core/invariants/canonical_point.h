// The geometry of a point in the canonical frame, from which the invariants of the cubics are
// computed.
#pragma once

#include <cmath>

namespace palpate {

/// Valid for either direction of travel and for vertical tangents, because nothing is divided by
/// the cosine. As functions of canonical x: y' = sine / cosine, y'' = kappa / cosine^3, y''' = jerk
/// / cosine^5.
template <typename T>
struct CanonicalPoint {
  T sine;    ///< of the tangent angle in the canonical frame
  T cosine;  ///< of the same angle
  T kappa;   ///< signed by the direction of travel
  T jerk;    ///< kappa_s cosine + 3 kappa^2 sine: the paper's (kappa_s + 3 lambda kappa^2) cosine
};

/// `angle`: tangent angle in the canonical frame, in the direction of travel. [rad]
template <typename T>
CanonicalPoint<T> canonical_point(const T& angle, const T& kappa, const T& kappa_s) {
  using std::cos;
  using std::sin;
  const T s = sin(angle);
  const T c = cos(angle);
  return {s, c, kappa, kappa_s * c + 3.0 * kappa * kappa * s};
}

}  // namespace palpate
