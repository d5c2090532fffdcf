// What a probe may say of a sample beside its position and a noise of one size.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/curves/pose2.h"

namespace palpate {

struct SampleDetail {
  /// Measured normal of the surface, unit, out of the material; zero = not measured.
  Vec2 normal = Vec2::Zero();
  double normal_sigma_rad = 0.0;  ///< standard deviation of its direction; 0 = not measured
  /// [xx, xy, yy] of the position's noise; zeros = alike in all directions. Where it is set, the
  /// sample's sigma_m is its mean. [m^2]
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();
};

/// Whether it says anything.
inline bool says_more(const SampleDetail& detail) {
  return detail.normal_sigma_rad > 0.0 || detail.covariance_m2.x() > 0.0;
}

/// Whether a measured normal is of unit length, as far as few decimals say it.
inline bool is_unit(const Vec2& normal) {
  constexpr double kFewDecimals = 1e-3;
  return std::abs(normal.norm() - 1.0) <= kFewDecimals;
}

/// Of length 1; what already is, to rounding, stays as it is.
inline Vec2 as_unit(const Vec2& normal) {
  constexpr double kRounding = 1e-15;
  const double length = normal.norm();
  return std::abs(length - 1.0) <= kRounding ? normal : Vec2(normal / length);
}

/// Whether [xx, xy, yy] is a covariance whose inverse doubles can hold.
inline bool is_covariance(const Eigen::Vector3d& c) {
  constexpr double kRounding = 1e-12;  // of a product, and some digits
  return c.x() > 0.0 && c.z() > 0.0 && c.x() * c.z() - c.y() * c.y() > kRounding * c.x() * c.z();
}

/// Whether all of it can be used: each part as described above, or absent.
inline bool is_sound(const SampleDetail& detail) {
  const bool no_normal = detail.normal.isZero(0.0) && detail.normal_sigma_rad == 0.0;
  const bool normal = is_unit(detail.normal) && detail.normal_sigma_rad > 0.0 &&
                      std::isfinite(detail.normal_sigma_rad);
  const bool covariance = detail.covariance_m2.allFinite() && is_covariance(detail.covariance_m2);
  return (no_normal || normal) && (detail.covariance_m2.isZero(0.0) || covariance);
}

/// For whoever knows noise of one size only. [m]
inline double mean_sigma_m(const Eigen::Vector3d& covariance_m2) {
  return std::sqrt(0.5 * (covariance_m2.x() + covariance_m2.z()));
}

}  // namespace palpate
