// The canonical tangent angle of a point, from two points. The paper's quartics, (42) for the
// cubical parabola and its counterpart for the semi-cubical one, reduce to quadratics.
#pragma once

#include <cmath>

namespace palpate {

/// With lambda1 = tan(phi) the paper's quartic is (1 + lambda1^2)(q2 lambda1^2 + q1 lambda1 + q0),
/// q2 = d4, q1 = d3, q0 = d0 (or e4, e3, e0). Its only real roots are those of
///     q2 sin^2(phi) + q1 sin(phi) cos(phi) + q0 cos^2(phi) = 0.
/// This equation is solved for the angle itself, so neither vertical tangents nor a rotation of
/// +-pi/2 between the tangents are singular.
template <typename T>
struct AngleQuadratic {
  T q2;
  T q1;
  T q0;
};

/// q1^2 - 4 q2 q0 relative to the size of the coefficients, in [-1, 1]. Negative: no real root.
template <typename T>
T relative_discriminant(const AngleQuadratic<T>& q) {
  // Twice the equation is (q0 + q2) + (q0 - q2) cos(2 phi) + q1 sin(2 phi) = 0.
  const T mean = q.q0 + q.q2;
  const T radius2 = (q.q0 - q.q2) * (q.q0 - q.q2) + q.q1 * q.q1;
  return (radius2 - mean * mean) / (radius2 + mean * mean);
}

/// One of the two roots phi [rad], modulo pi; `branch` is +1 or -1. Precondition: the relative
/// discriminant is positive.
template <typename T>
T canonical_angle(const AngleQuadratic<T>& q, double branch) {
  using std::atan2;
  using std::sqrt;
  const T mean = q.q0 + q.q2;
  const T difference = q.q0 - q.q2;
  const T discriminant = difference * difference + q.q1 * q.q1 - mean * mean;
  return 0.5 * (atan2(q.q1, difference) + branch * atan2(sqrt(discriminant), -mean));
}

/// The angle at which the quadratic comes closest to zero, for a quadratic without a real root.
/// [rad]
inline double nearest_angle(const AngleQuadratic<double>& q) {
  const double sign = q.q0 + q.q2 > 0.0 ? -1.0 : 1.0;
  return 0.5 * std::atan2(sign * q.q1, sign * (q.q0 - q.q2));
}

}  // namespace palpate
