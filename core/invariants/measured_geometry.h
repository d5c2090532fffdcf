// The input of all invariants: tangent angle, kappa and kappa_s of one touched point with their
// joint covariance; and the scale that makes a set of points dimensionless.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/local/local_estimate.h"

namespace palpate {

struct MeasuredGeometry {
  /// In the direction of travel, in a frame common to all points [rad]
  double tangent_angle = 0.0;
  double kappa = 0.0;    ///< signed by the direction of travel [1/m]
  double kappa_s = 0.0;  ///< [1/m^2]
  /// Of (tangent_angle, kappa, kappa_s); zero if the values are exact.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Points of one patch share one direction of travel; points of different patches need not.
  int patch = 0;
};

MeasuredGeometry measured_geometry(const LocalEstimate& estimate, int patch = 0);

bool is_finite(const MeasuredGeometry& point);
bool are_finite(std::span<const MeasuredGeometry> points);

/// The largest of |kappa| and sqrt|kappa_s| over the points [1/m]. With its inverse as the unit of
/// length every curve has a size of about one, so no threshold depends on the unit. 0 for a
/// straight line or no points.
double curvature_scale(std::span<const MeasuredGeometry> points);

/// The point with lengths measured in units of `unit` [m].
MeasuredGeometry in_units_of(const MeasuredGeometry& point, double unit);

}  // namespace palpate
