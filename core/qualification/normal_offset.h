// The distance of a probe's samples from the surface, as a function of the direction of the surface
// normal.
#pragma once

#include <Eigen/Core>

#include "core/recognition/coherent/offset_harmonics.h"

namespace palpate {

/// offset(phi) = c_0 + sum over k = 2 ... order of c_k cos k phi + s_k sin k phi. phi is the
/// direction of the normal out of the material, in the frame of the samples. There is no k = 1: a
/// shift of the frame by (x, y) moves the samples of any part out by x cos phi + y sin phi, so no
/// part at an unknown place can show that harmonic.
struct NormalOffset {
  int order = 0;                                              ///< 0 = the constant alone
  Eigen::VectorXd coefficients_m = Eigen::VectorXd::Zero(1);  ///< [c_0; c_2; s_2; c_3; ...] [m]
  Eigen::MatrixXd covariance_m2 = Eigen::MatrixXd::Zero(1, 1);
};

/// The factor of each coefficient at `phi`, and its first and second derivatives by phi.
Eigen::RowVectorXd offset_basis(double phi, int order);
Eigen::RowVectorXd offset_basis_slope(double phi, int order);
Eigen::RowVectorXd offset_basis_bend(double phi, int order);

/// The largest amplitude of any of its harmonics. [m]
double largest_lobe_m(const NormalOffset& offset);

/// Mean square of all but its constant, over all directions, and their mean variance. [m^2]
double mean_square_of_lobes(const NormalOffset& offset);
double mean_variance_of_lobes(const NormalOffset& offset);

/// The offset in direction `phi`. [m]
double offset_at(const NormalOffset& offset, double phi);
/// Standard deviation of the offset in direction `phi`. [m]
double offset_deviation_at(const NormalOffset& offset, double phi);

}  // namespace palpate
