// Equations for the cubic spline segment (t^2, a t^3 + b t^2 + c t) that do not contain its
// parameter t: (49) and the closed form of c, without denominators.
#pragma once

#include <cmath>

#include "core/invariants/canonical_point.h"

namespace palpate {

/// The terms at one point that (49) and the formula for c share. With the paper's L and M:
///     lambda - b = e / cosine,  L = 2 kappa / cosine^3,  M = jerk cosine / kappa^2.
/// L is signed for travel with increasing x, so its two signs are the two orientations of the
/// frame.
template <typename T>
struct SplinePoint {
  T e;       ///< (lambda - b) cosine
  T kappa;   ///< signed by the direction of travel
  T jerk;    ///< see CanonicalPoint
  T cosine;  ///< of the tangent angle
  T w;       ///< a^2 cosine^4
};

template <typename T>
SplinePoint<T> spline_point(const CanonicalPoint<T>& p, const T& a, const T& b) {
  const T c2 = p.cosine * p.cosine;
  return {p.sine - b * p.cosine, p.kappa, p.jerk, p.cosine, a * a * c2 * c2};
}

/// (49) times cosine^13 kappa^2, which is a polynomial, divided by the Euclidean norm of its terms:
/// in [-sqrt(6), sqrt(6)] for all arguments, 0 if all terms are 0. The paper divides by 81 M a^4
/// instead, which diverges at inflections (jerk = 0 or kappa = 0) and for a -> 0.
template <typename T>
T spline_residual(const SplinePoint<T>& p) {
  using std::sqrt;
  const T k2 = p.kappa * p.kappa;
  const T je = p.jerk * p.e;
  const T terms[] = {81.0 * p.jerk * p.w * p.w,   36.0 * p.kappa * k2 * p.w,
                     -108.0 * p.kappa * je * p.w, -36.0 * p.e * k2 * k2,
                     24.0 * k2 * je * p.e,        -4.0 * je * je * p.e};
  T sum = terms[0];
  T norm2 = terms[0] * terms[0];
  for (int i = 1; i < 6; ++i) {
    sum += terms[i];
    norm2 += terms[i] * terms[i];
  }
  return norm2 > 0.0 ? sum / sqrt(norm2) : sum;
}

/// The formula for c that follows (50): c = numerator / denominator. Both vanish at an inflection,
/// and where (45) and (46) coincide.
struct SplineC {
  double numerator = 0.0;
  double denominator = 0.0;
};

inline SplineC spline_c(const SplinePoint<double>& p, double a) {
  const double k2 = p.kappa * p.kappa;
  const double je = p.jerk * p.e;
  return {-p.e * ((9.0 * p.w - 4.0 * p.e * p.kappa) * (3.0 * k2 - je) - 18.0 * p.w * k2),
          3.0 * a * p.cosine * p.cosine * (4.0 * p.kappa * (k2 - je) + 9.0 * p.w * p.jerk)};
}

}  // namespace palpate
