// How far a probe's samples lie from the surface, by the direction of the surface's normal.
#pragma once

#include <Eigen/Core>

namespace palpate {

/// offset(phi) = c_0 + sum over k = 2 ... order of c_k cos k phi + s_k sin k phi, phi the direction
/// of the normal out of the material, in the samples' frame. There is no k = 1: moved by (x, y),
/// any part's samples lie x cos phi + y sin phi farther out, so that this harmonic is a shift of
/// the frame and nothing that a part at an unknown place could tell.
struct NormalOffset {
  int order = 0;                                              ///< 0 = the constant alone
  Eigen::VectorXd coefficients_m = Eigen::VectorXd::Zero(1);  ///< [c_0; c_2; s_2; c_3; ...] [m]
  Eigen::MatrixXd covariance_m2 = Eigen::MatrixXd::Zero(1, 1);
};

/// Length of the coefficients up to `order`.
int offset_coefficients(int order);

/// What each coefficient is multiplied by at `phi`, and the derivative of that by phi.
Eigen::RowVectorXd offset_basis(double phi, int order);
Eigen::RowVectorXd offset_basis_slope(double phi, int order);

/// [m]
double offset_at(const NormalOffset& offset, double phi);
/// Its standard deviation. [m]
double offset_deviation_at(const NormalOffset& offset, double phi);

}  // namespace palpate
