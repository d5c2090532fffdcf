// Differential geometry of a graph v(u), and the propagation of errors of its derivatives.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace palpate {

struct GraphGeometry {
  double angle = 0.0;    ///< of the tangent against the u axis, in (-pi/2, pi/2) [rad]
  double kappa = 0.0;    ///< curvature, (1) for the parametrisation (u, v(u))
  double kappa_s = 0.0;  ///< derivative of the curvature by arc length, (2)
  /// Derivatives of (offset along the normal, angle, kappa, kappa_s) by (v, v', v'', v''', v'''').
  /// Errors are relative to the truth at the foot of the point on the true curve: an error dv moves
  /// the point along the normal by dv cos(angle) and along the curve by dv sin(angle), where the
  /// true angle, kappa and kappa_s are different.
  Eigen::Matrix<double, 4, 5> jacobian;
};

/// `derivatives`: v, v', v'', v''', v'''' at one abscissa.
inline GraphGeometry graph_geometry(const Eigen::Matrix<double, 5, 1>& derivatives) {
  const double p = derivatives[1];
  const double q = derivatives[2];
  const double r = derivatives[3];
  const double g = 1.0 + p * p;
  const double root = std::sqrt(g);
  const double g3 = g * g * g;
  const double n = r * g - 3.0 * p * q * q;
  const double n_u = derivatives[4] * g - 4.0 * p * q * r - 3.0 * q * q * q;

  GraphGeometry result;
  result.angle = std::atan(p);
  result.kappa = q / (g * root);
  result.kappa_s = n / g3;
  const double kappa_ss = (n_u - 6.0 * p * q * n / g) / (g3 * root);

  auto& j = result.jacobian;
  j.setZero();
  const double sine = p / root;
  j(0, 0) = 1.0 / root;
  j(1, 0) = -result.kappa * sine;
  j(2, 0) = -result.kappa_s * sine;
  j(3, 0) = -kappa_ss * sine;
  j(1, 1) = 1.0 / g;
  j(2, 1) = -3.0 * p * q / (g * g * root);
  j(3, 1) = (2.0 * p * r - 3.0 * q * q - 6.0 * p * n / g) / g3;
  j(2, 2) = 1.0 / (g * root);
  j(3, 2) = -6.0 * p * q / g3;
  j(3, 3) = 1.0 / (g * g);
  return result;
}

}  // namespace palpate
