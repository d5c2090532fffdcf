// Measured normals beside a fitted curve's own: residuals of the classes' fits.
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

/// A point's measured normal as a residual: the weight by the curve found, not by each one sought.
struct WeighedNormal {
  std::size_t point = 0;
  double weight = 0.0;
};

/// The angle from a measured normal to the curve's, left positive, either way round: in [-pi/2,
/// pi/2]. Both of unit length. [rad]
inline double normal_miss(const Vec2& measured, const Vec2& of_curve) {
  const double along = measured.dot(of_curve);
  const double across = cross(measured, of_curve);
  return along >= 0.0 ? std::atan2(across, along) : std::atan2(-across, -along);
}

/// A curve at a point's foot, and how far off it the point is: what turns the normal there.
struct NormalAtFoot {
  Vec2 normal = Vec2::Zero();  ///< unit, left of `first`
  Vec2 first = Vec2::Zero();   ///< derivatives of the curve by its parameter
  Vec2 second = Vec2::Zero();
  double distance = 0.0;  ///< of the point, positive along the normal

  double speed() const { return first.norm(); }

  /// Derivative of (C - p) . C' by the parameter: beyond the centre of curvature no foot is
  /// followed.
  double slope() const { return first.squaredNorm() - distance * normal.dot(second); }

  bool is_followed() const {
    return slope() >= kLeastFootSlope * first.squaredNorm() && first.squaredNorm() > 0.0;
  }

  /// By what angle the normal turns where the point moves by 1 along the curve.
  double turn_along() const { return normal.dot(second) / slope(); }

  /// By what angle the normal at the foot of the point, which stays, turns where the curve moves by
  /// `v` at the same parameter, `v_by_t` its derivative by that: the foot slides on.
  double turn_by(const Vec2& v, const Vec2& v_by_t) const {
    const double slide = (distance * normal.dot(v_by_t) - first.dot(v)) / slope();
    return normal.dot(v_by_t + slide * second) / speed();
  }
};

/// Weight of a normal's residual: its own variance and that of the foot's place, which noise along
/// the curve puts beside the touch, where the curve has turned on. `turn_along`: [rad over a
/// normalised length].
inline double normal_weight(const FitPoint& point, double turn_along) {
  const double of_place = turn_along * point.along_over_across / point.inverse_sigma;
  const double own = 1.0 / point.inverse_normal_sigma;
  return 1.0 / std::sqrt(own * own + of_place * of_place);
}

}  // namespace palpate
