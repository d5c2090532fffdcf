// The result of a local estimator for one place of the touched curve.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/curves/pose2.h"

namespace palpate {

/// Local differential geometry in the world frame, signed by the direction of travel.
struct LocalEstimate {
  Vec2 position = Vec2::Zero();  ///< the point of the fitted curve that the estimate belongs to [m]
  double tangent_angle = 0.0;    ///< direction of travel [rad]
  double kappa = 0.0;            ///< curvature [1/m]
  double kappa_s = 0.0;          ///< derivative of the curvature by arc length [1/m^2]
  /// Joint covariance of (offset along the left normal [m], tangent angle [rad], kappa, kappa_s).
  /// Zero if the noise is zero. Its diagonal is infinite if the estimator cannot determine it.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double window_arc_m = 0.0;  ///< arc length from the first to the last sample of the window [m]
  int window_samples = 0;     ///< number of samples used
  double sigma_m = 0.0;       ///< noise used: as given, or estimated from the residuals [m]
};

/// The angle needs no test: it comes of the same frame and slope as position and curvature.
inline bool is_finite(const LocalEstimate& e) {
  return e.position.allFinite() && std::isfinite(e.kappa) && std::isfinite(e.kappa_s) &&
         e.covariance.allFinite() && std::isfinite(e.window_arc_m);
}

}  // namespace palpate
