// A contact point for the fit of a given class.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/curves/pose2.h"

namespace palpate {

/// One contact point. The order of points does not matter, but for those of a stroke.
struct GivenPoint {
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;  ///< 1-sigma isotropic noise; 0 = not known [m]
  /// The point is the centre of a round tip of this radius; 0 = surface point. [m]
  double tip_radius_m = 0.0;
  /// Roughly into the material, of any length; zero = not known. Only tips need it.
  Vec2 into_material = Vec2::Zero();
  /// Measured surface normal, of any length, out of the material; zero = not measured. The sign
  /// matters only for the side of a tip. The direction is used only if every point's noise is
  /// known.
  Vec2 normal = Vec2::Zero();
  double normal_sigma_rad = 0.0;  ///< standard deviation of that direction; 0 = not measured [rad]
  /// Covariance [xx, xy, yy] of the position, in place of sigma_m; zeros = not known. [m^2]
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();
  /// Number of the stroke that the point was touched in, from 1. Its points follow one another as
  /// the probe went. 0 = no stroke, or one whose order is not known.
  std::size_t stroke = 0;
  /// An outlier by the caller's decision: gets a residual, but is not fitted.
  bool set_aside = false;
};

/// True if all numbers are finite and every noise, normal and covariance is valid or absent.
bool is_sound(const GivenPoint& point);

inline bool has_normal(const GivenPoint& point) { return point.normal_sigma_rad > 0.0; }

/// Isotropic noise of a point (a covariance's mean, its sigma_m or the default); 0 = not known. [m]
double noise_of(const GivenPoint& point, double default_sigma_m);

}  // namespace palpate
