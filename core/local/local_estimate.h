// What a local estimator says about one place of the touched curve.
#pragma once

#include <Eigen/Core>

#include "core/curves/pose2.h"

namespace palpate {

/// Local differential geometry in the world frame, signed by the direction of travel.
struct LocalEstimate {
  Vec2 position = Vec2::Zero();  ///< point of the fitted curve that the estimate is for [m]
  double tangent_angle = 0.0;    ///< direction of travel [rad]
  double kappa = 0.0;            ///< curvature [1/m]
  double kappa_s = 0.0;          ///< its derivative by arc length [1/m^2]
  /// Joint covariance of (offset along the left normal [m], tangent angle [rad], kappa, kappa_s).
  /// Zero where the noise is zero; its diagonal is infinite where the estimator cannot tell.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double window_arc_m = 0.0;  ///< arc length from the first to the last sample of the window [m]
  int window_samples = 0;     ///< samples that the estimate used
  double sigma_m = 0.0;       ///< noise used: given, or estimated from the window's residuals [m]
};

}  // namespace palpate
