#include "core/local/tip_radius.h"

#include <cmath>

namespace palpate {

std::optional<LocalEstimate> surface_from_tip(const LocalEstimate& centre, double tip_offset_m) {
  const double d = tip_offset_m;
  const double stretch = 1.0 + d * centre.kappa;  // ds / ds_c
  if (!(stretch > 0.0) || !std::isfinite(stretch)) {
    return std::nullopt;
  }
  LocalEstimate surface = centre;
  surface.position -= d * Vec2(-std::sin(centre.tangent_angle), std::cos(centre.tangent_angle));
  surface.kappa = centre.kappa / stretch;
  surface.kappa_s = centre.kappa_s / (stretch * stretch * stretch);
  // An error of the angle moves the new point by d * error along the curve.
  Eigen::Matrix4d jacobian = Eigen::Matrix4d::Zero();
  jacobian(0, 0) = 1.0;
  jacobian(1, 1) = 1.0 - d * surface.kappa;
  jacobian(2, 1) = -d * surface.kappa_s;
  jacobian(2, 2) = 1.0 / (stretch * stretch);
  jacobian(3, 2) = -3.0 * d * surface.kappa_s / stretch;
  jacobian(3, 3) = 1.0 / (stretch * stretch * stretch);
  surface.covariance = jacobian * centre.covariance * jacobian.transpose();
  // The window turns by the same angle, so its arc changes by the ratio at the place of the
  // estimate.
  surface.window_arc_m = centre.window_arc_m * stretch;
  return surface;
}

}  // namespace palpate
