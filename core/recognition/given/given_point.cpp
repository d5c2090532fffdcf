#include "core/recognition/given/given_point.h"

#include <cmath>

#include "core/recognition/samples/sample_detail.h"

namespace palpate {

double noise_of(const GivenPoint& point, double default_sigma_m) {
  if (point.covariance_m2.x() > 0.0) {
    return mean_sigma_m(point.covariance_m2);
  }
  return point.sigma_m > 0.0 ? point.sigma_m : default_sigma_m;
}

bool is_sound(const GivenPoint& point) {
  const Eigen::Vector3d& c = point.covariance_m2;
  const bool covariance = c.isZero(0.0) || (c.x() > 0.0 && c.x() * c.z() > c.y() * c.y());
  const bool normal = point.normal_sigma_rad == 0.0 ||
                      (point.normal_sigma_rad > 0.0 && point.normal.squaredNorm() > 0.0);
  return point.position_m.allFinite() && point.into_material.allFinite() &&
         point.normal.allFinite() && c.allFinite() && point.sigma_m >= 0.0 &&
         std::isfinite(point.sigma_m) && point.tip_radius_m >= 0.0 &&
         std::isfinite(point.tip_radius_m) && std::isfinite(point.normal_sigma_rad) && covariance &&
         normal;
}

}  // namespace palpate
