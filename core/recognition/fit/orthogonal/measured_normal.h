// Measured normals as residuals of the classes' fits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/curves/plane_curve.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

inline bool has_normal(const FitPoint& point) { return point.inverse_normal_sigma > 0.0; }

inline std::size_t count_normals(std::span<const FitPoint> points) {
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const FitPoint& point) { return has_normal(point); }));
}

/// A point's measured normal with its weight, which comes from the curve found and is not changed
/// with each trial curve.
struct WeighedNormal {
  std::size_t point = 0;
  double weight = 0.0;
};

/// Angle from a measured normal to the curve's, left positive, without regard to their sign: in
/// [-pi/2, pi/2]. Both of unit length. [rad]
inline double normal_miss(const Vec2& measured, const Vec2& of_curve) {
  const double along = measured.dot(of_curve);
  const double across = cross(measured, of_curve);
  return along >= 0.0 ? std::atan2(across, along) : std::atan2(-across, -along);
}

/// A curve at a point's foot, with the point's distance: all that determines how the normal turns.
struct NormalAtFoot {
  Vec2 normal = Vec2::Zero();  ///< unit, left of `first`
  Vec2 first = Vec2::Zero();   ///< derivatives of the curve by its parameter
  Vec2 second = Vec2::Zero();
  double distance = 0.0;  ///< of the point, positive along the normal

  double speed() const { return first.norm(); }

  /// Derivative of (C - p) . C' by the parameter. Beyond the centre of curvature the foot cannot be
  /// followed.
  double slope() const { return first.squaredNorm() - distance * normal.dot(second); }

  bool is_followed() const {
    return slope() >= kLeastFootSlope * first.squaredNorm() && first.squaredNorm() > 0.0;
  }

  /// Angle by which the normal turns if the point moves by 1 along the curve.
  double turn_along() const { return normal.dot(second) / slope(); }

  /// Angle by which the normal at the foot of the fixed point turns if the curve moves by `v` at
  /// the same parameter. `v_by_t`: derivative of `v` by the parameter. It includes the slide of the
  /// foot.
  double turn_by(const Vec2& v, const Vec2& v_by_t) const {
    const double slide = (distance * normal.dot(v_by_t) - first.dot(v)) / slope();
    return normal.dot(v_by_t + slide * second) / speed();
  }
};

/// Weight of a normal's residual, from its own variance and that of the foot's place: position
/// noise along the curve moves the foot to where the curve's normal has turned. `turn_along`: [rad
/// over a normalised length].
inline double normal_weight(const FitPoint& point, double turn_along) {
  const double of_place = turn_along * point.along_over_across / point.inverse_sigma;
  const double own = 1.0 / point.inverse_normal_sigma;
  return 1.0 / std::sqrt(own * own + of_place * of_place);
}

}  // namespace palpate
