#include "core/local/tip_radius.h"

#include <cmath>

namespace palpate {
namespace {

/// Moves the estimate by `d` against its left normal: from centres at the offset d to the surface.
std::optional<LocalEstimate> moved(const LocalEstimate& from, double d) {
  const double stretch = 1.0 + d * from.kappa;  // ds_from / ds_to
  if (!(stretch > 0.0) || !std::isfinite(stretch)) {
    return std::nullopt;
  }
  LocalEstimate to = from;
  to.position -= d * Vec2(-std::sin(from.tangent_angle), std::cos(from.tangent_angle));
  to.kappa = from.kappa / stretch;
  to.kappa_s = from.kappa_s / (stretch * stretch * stretch);
  // An error of the angle moves the new point by d * error along the curve.
  Eigen::Matrix4d jacobian = Eigen::Matrix4d::Zero();
  jacobian(0, 0) = 1.0;
  jacobian(1, 1) = 1.0 - d * to.kappa;
  jacobian(2, 1) = -d * to.kappa_s;
  jacobian(2, 2) = 1.0 / (stretch * stretch);
  jacobian(3, 2) = -3.0 * d * to.kappa_s / stretch;
  jacobian(3, 3) = 1.0 / (stretch * stretch * stretch);
  to.covariance = jacobian * from.covariance * jacobian.transpose();
  // The window turns by the same angle, so its arc changes by the ratio at the place of the
  // estimate.
  to.window_arc_m = from.window_arc_m / stretch;
  return to;
}

}  // namespace

std::optional<LocalEstimate> surface_from_tip(const LocalEstimate& centre, double tip_offset_m) {
  return moved(centre, tip_offset_m);
}

std::optional<LocalEstimate> tip_from_surface(const LocalEstimate& surface, double tip_offset_m) {
  return moved(surface, -tip_offset_m);
}

}  // namespace palpate
