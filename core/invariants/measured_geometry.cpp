#include "core/invariants/measured_geometry.h"

#include <algorithm>
#include <cmath>

namespace palpate {

MeasuredGeometry measured_geometry(const LocalEstimate& estimate, int patch) {
  return {.tangent_angle = estimate.tangent_angle,
          .kappa = estimate.kappa,
          .kappa_s = estimate.kappa_s,
          .covariance = estimate.covariance.bottomRightCorner<3, 3>(),
          .patch = patch};
}

bool is_finite(const MeasuredGeometry& point) {
  return std::isfinite(point.tangent_angle) && std::isfinite(point.kappa) &&
         std::isfinite(point.kappa_s) && point.covariance.allFinite();
}

bool are_finite(std::span<const MeasuredGeometry> points) {
  return std::all_of(points.begin(), points.end(),
                     [](const MeasuredGeometry& point) { return is_finite(point); });
}

double curvature_scale(std::span<const MeasuredGeometry> points) {
  double scale = 0.0;
  for (const MeasuredGeometry& point : points) {
    scale = std::max({scale, std::abs(point.kappa), std::sqrt(std::abs(point.kappa_s))});
  }
  return scale;
}

MeasuredGeometry in_units_of(const MeasuredGeometry& point, double unit) {
  const Eigen::Vector3d factor(1.0, unit, unit * unit);
  return {.tangent_angle = point.tangent_angle,
          .kappa = point.kappa * factor[1],
          .kappa_s = point.kappa_s * factor[2],
          .covariance = factor.asDiagonal() * point.covariance * factor.asDiagonal(),
          .patch = point.patch};
}

}  // namespace palpate
