// The semi-differential invariants Ic1 and Ic2 of a conic from two points, (26) and (28).
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"

namespace palpate {

/// Ellipse: Ic1 = (ab)^(-2/3); hyperbola: -(ab)^(-2/3); parabola: 0 [m^(-4/3)]. Ellipse and
/// hyperbola: Ic2 = (a^2 +- b^2) / (ab)^(4/3); parabola: (2a)^(-2/3) [m^(-2/3)]. Erratum: Ic1 is
/// the affine curvature of the ellipse itself; the paper's factor pi^(2/3) between them is wrong.
struct ConicInvariants {
  InvariantStatus status = InvariantStatus::TooFewPoints;
  double ic1 = 0.0;
  double ic2 = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (ic1, ic2), to first order
};

/// (26) and (28). Precondition: kappa1, kappa2 != 0 and |kappa1| != |kappa2|.
template <typename T>
void conic_pair(const T& kappa1, const T& kappa_s1, const T& kappa2, const T& kappa_s2, T& ic1,
                T& ic2) {
  using std::abs;
  using std::cbrt;
  // With k = |kappa|^(2/3) and Ip = k (1 + tau^2), (26) is k1 k2 (1 + (k1 tau1^2 - k2 tau2^2) / (k1
  // - k2)). Near a circle, Ip1 - Ip2 would cancel. This form takes the difference from the
  // curvatures themselves, and loses only digits that the data do not have.
  const T root1 = cbrt(abs(kappa1));
  const T root2 = cbrt(abs(kappa2));
  const T k1 = root1 * root1;
  const T k2 = root2 * root2;
  const T difference = (abs(kappa1) - abs(kappa2)) * (root1 + root2) / (k1 + root1 * root2 + k2);
  const T tau1 = kappa_s1 / (3.0 * kappa1 * kappa1);
  const T tau2 = kappa_s2 / (3.0 * kappa2 * kappa2);
  const T ratio = 1.0 + (k1 * tau1 * tau1 - k2 * tau2 * tau2) / difference;
  ic1 = k1 * k2 * ratio;
  // Ic2 = Ip + Ic1 / k, from the point with the larger curvature, where both terms are smaller.
  ic2 = k1 > k2 ? k1 * (1.0 + tau1 * tau1) + k2 * ratio : k2 * (1.0 + tau2 * tau2) + k1 * ratio;
}

/// Ic1 and Ic2 from two points. PointsTooAlike if the curvatures are equal; SignChange if the
/// points are of one patch and their curvatures have opposite signs.
ConicInvariants conic_invariants(const MeasuredGeometry& point1, const MeasuredGeometry& point2);

}  // namespace palpate
