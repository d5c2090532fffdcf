// What a probe may state about a sample besides its position and isotropic noise.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/curves/pose2.h"

namespace palpate {

struct SampleDetail {
  /// Measured surface normal, unit length, out of the material; zero = not measured.
  Vec2 normal = Vec2::Zero();
  double normal_sigma_rad = 0.0;  ///< standard deviation of its direction; 0 = not measured [rad]
  /// Covariance [xx, xy, yy] of the position; zeros = isotropic noise. If set, the sample's sigma_m
  /// must be mean_sigma_m(covariance_m2). [m^2]
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();

  bool operator==(const SampleDetail&) const = default;
};

/// True if it has a normal or a covariance.
inline bool says_more(const SampleDetail& detail) {
  return detail.normal_sigma_rad > 0.0 || detail.covariance_m2.x() > 0.0;
}

/// True if a measured normal has length 1 to three decimals.
inline bool is_unit(const Vec2& normal) {
  constexpr double kFewDecimals = 1e-3;
  return std::abs(normal.norm() - 1.0) <= kFewDecimals;
}

/// Scaled to length 1. A vector that has length 1 to rounding stays unchanged.
inline Vec2 as_unit(const Vec2& normal) {
  constexpr double kRounding = 1e-15;
  const double length = normal.norm();
  return std::abs(length - 1.0) <= kRounding ? normal : Vec2(normal / length);
}

/// True if [xx, xy, yy] is positive definite enough to be inverted in double precision.
inline bool is_covariance(const Eigen::Vector3d& c) {
  constexpr double kRounding = 1e-12;  // rounding of a product, and some digits
  return c.x() > 0.0 && c.z() > 0.0 && c.x() * c.z() - c.y() * c.y() > kRounding * c.x() * c.z();
}

/// True if the normal and the covariance are each valid or absent.
inline bool is_sound(const SampleDetail& detail) {
  const bool no_normal = detail.normal.isZero(0.0) && detail.normal_sigma_rad == 0.0;
  const bool normal = is_unit(detail.normal) && detail.normal_sigma_rad > 0.0 &&
                      std::isfinite(detail.normal_sigma_rad);
  const bool covariance = detail.covariance_m2.allFinite() && is_covariance(detail.covariance_m2);
  return (no_normal || normal) && (detail.covariance_m2.isZero(0.0) || covariance);
}

/// Isotropic noise with the same mean variance. [m]
inline double mean_sigma_m(const Eigen::Vector3d& covariance_m2) {
  return std::sqrt(0.5 * (covariance_m2.x() + covariance_m2.z()));
}

}  // namespace palpate
