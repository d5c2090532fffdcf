// What the cubics' invariants are made of: a point's geometry seen in the canonical frame.
#pragma once

#include <cmath>

namespace palpate {

/// Valid for either direction of travel and for vertical tangents: nothing is divided by the
/// cosine. y' = sine / cosine, y'' = kappa / cosine^3, y''' = jerk / cosine^5 as functions of
/// canonical x.
template <typename T>
struct CanonicalPoint {
  T sine;    ///< of the tangent angle in the canonical frame
  T cosine;  ///< of the same
  T kappa;   ///< signed by the direction of travel
  T jerk;    ///< kappa_s cosine + 3 kappa^2 sine: the paper's (kappa_s + 3 lambda kappa^2) cosine
};

/// `angle`: of the tangent in the canonical frame, in the direction of travel.
template <typename T>
CanonicalPoint<T> canonical_point(const T& angle, const T& kappa, const T& kappa_s) {
  using std::cos;
  using std::sin;
  const T s = sin(angle);
  const T c = cos(angle);
  return {s, c, kappa, kappa_s * c + 3.0 * kappa * kappa * s};
}

}  // namespace palpate
