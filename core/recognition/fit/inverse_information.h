// From what residuals tell of shape and pose to their covariance.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/curves/shape_parameters.h"

namespace palpate {

/// A residual by [x; y; theta; shape], over noise.
using ResidualRow = Eigen::Matrix<double, 6, 1>;

/// Covariance of n unknown components: infinite variances, no covariances.
ShapePoseCovariance untold_covariance(Eigen::Index n);

/// Inverse of the information of [shape; x; y; theta]; what the pose symmetry leaves free gets
/// variance 0.
struct InverseInformation {
  ShapePoseCovariance covariance;
  double log_determinant = 0.0;  ///< of the information, without the free directions
  /// Least eigenvalue of the information scaled to a diagonal of ones, of those directions: what
  /// rounding leaves of it is off by about epsilon.
  double weakest = 0.0;
};
/// `theta`: the pose's.
InverseInformation inverse_information(const ShapePoseCovariance& information,
                                       CurveClass curve_class, double theta);

/// The covariance of [pose; shape] from the rows themselves: a product of them has lost what its
/// weakest direction is, if that is below the root of epsilon. Beside a cubical parabola, with the
/// vertex far away, a spline's shape and pose make up for one another to many digits. Six rows at
/// least. Not finite where they do not tell all.
Eigen::Matrix<double, 6, 6> covariance_from_rows(const std::vector<ResidualRow>& rows);

}  // namespace palpate
