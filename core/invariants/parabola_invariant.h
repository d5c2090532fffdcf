// The differential invariant Ip of a parabola, (19).
#pragma once

#include <cmath>

namespace palpate {

/// |kappa|^(2/3), the form in which the curvature enters every invariant of a conic. Erratum: the
/// paper prints kappa^(2/3) in (14), (18), (26), (28) and (31), where kappa is negative in its own
/// parametrisations; the absolute value is meant.
template <typename T>
T curvature_two_thirds(const T& kappa) {
  using std::cbrt;
  const T root = cbrt(kappa);
  return root * root;
}

/// Ip = |kappa|^(2/3) (kappa_s^2 / (9 kappa^4) + 1), (19) [m^(-2/3)]. Along a parabola y^2 = 4 a x
/// it has the constant value (2a)^(-2/3). Precondition: kappa != 0.
template <typename T>
T parabola_invariant(const T& kappa, const T& kappa_s) {
  // tau is the canonical parameter t of a point of a parabola (section 5.3). It is of size one, so
  // neither kappa^4 nor kappa_s^2 is computed.
  const T tau = kappa_s / (3.0 * kappa * kappa);
  return curvature_two_thirds(kappa) * (1.0 + tau * tau);
}

}  // namespace palpate
