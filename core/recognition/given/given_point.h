// A contact point to which a class that is given is fitted.
#pragma once

#include <Eigen/Core>

#include "core/curves/pose2.h"

namespace palpate {

/// One contact point; its neighbours do not matter.
struct GivenPoint {
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;       ///< 1-sigma noise, alike in all directions; 0 = not known [m]
  double tip_radius_m = 0.0;  ///< the point is the centre of a round tip; 0 = surface [m]
  /// Roughly into the material, of any length; zero where it is not known. Only tips need it.
  Vec2 into_material = Vec2::Zero();
  /// Measured normal of the surface, of any length: out of the material, if the material matters;
  /// zero = not measured. Its direction counts where every point's noise is known.
  Vec2 normal = Vec2::Zero();
  double normal_sigma_rad = 0.0;  ///< standard deviation of that direction
  /// [xx, xy, yy] of the position's noise, in place of sigma_m; zeros = not known [m^2]
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();
  bool set_aside = false;  ///< an outlier by the caller's word: its residual is told, no more
};

/// Every number finite, every noise a noise.
bool is_sound(const GivenPoint& point);

inline bool has_normal(const GivenPoint& point) { return point.normal_sigma_rad > 0.0; }

/// Noise of a point, the same in all directions; 0 where it is not known. [m]
double noise_of(const GivenPoint& point, double default_sigma_m);

}  // namespace palpate
