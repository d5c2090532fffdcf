// Rigid motions of the plane, SE(2). Reflections are never applied: chirality is part of a shape.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace palpate {

using Vec2 = Eigen::Vector2d;

inline constexpr double kPi = std::numbers::pi;

/// Wraps an angle to (-pi, pi]. [rad]
inline double wrap_angle(double angle) {
  if (std::abs(angle) < kPi) {
    return angle;  // a shortcut without the division of std::remainder
  }
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// The vector turned by +90 degrees: the left normal of a tangent.
inline Vec2 left_of(const Vec2& v) { return {-v.y(), v.x()}; }

/// z component of the cross product of two plane vectors.
inline double cross(const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); }

/// The angle by which u turns into the direction of v, within [-pi, pi]. [rad]
inline double turn_between(const Vec2& u, const Vec2& v) {
  return std::atan2(cross(u, v), u.dot(v));
}

/// A pose A_T_B. It transforms coordinates from frame B to frame A: p_A = R(theta) p_B + (x, y).
struct Pose2 {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad]

  Vec2 translation() const { return {x, y}; }

  /// R(theta) v, for directions and differences.
  Vec2 rotate(const Vec2& v) const {
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
  }

  /// R(-theta) v.
  Vec2 rotate_back(const Vec2& v) const {
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    return {c * v.x() + s * v.y(), -s * v.x() + c * v.y()};
  }

  Vec2 operator*(const Vec2& p) const { return rotate(p) + translation(); }

  /// A_T_C = A_T_B * B_T_C, with theta wrapped.
  Pose2 operator*(const Pose2& other) const {
    const Vec2 t = *this * other.translation();
    return {t.x(), t.y(), wrap_angle(theta + other.theta)};
  }

  /// Coordinates in frame B of a point given in frame A. Does not form the inverse pose.
  Vec2 to_local(const Vec2& p) const { return rotate_back(p - translation()); }

  Pose2 inverse() const {
    const Vec2 t = rotate_back(-translation());
    return {t.x(), t.y(), -theta};
  }
};

/// The pose of this turn that carries `from` to `to`.
inline Pose2 pose_carrying(double theta, const Vec2& from, const Vec2& to) {
  Pose2 pose{0.0, 0.0, theta};
  const Vec2 shift = to - pose.rotate(from);
  pose.x = shift.x();
  pose.y = shift.y();
  return pose;
}

/// The frame at an origin with this x axis, of any length.
inline Pose2 pose_along(const Vec2& origin, const Vec2& x_axis) {
  return {origin.x(), origin.y(), std::atan2(x_axis.y(), x_axis.x())};
}

/// Pose2::to_local for many points: computes sine and cosine once.
class ToLocal {
 public:
  explicit ToLocal(const Pose2& pose)
      : origin_(pose.x, pose.y), cosine_(std::cos(pose.theta)), sine_(std::sin(pose.theta)) {}

  Vec2 operator()(const Vec2& p) const {
    const Vec2 d = p - origin_;
    return {cosine_ * d.x() + sine_ * d.y(), -sine_ * d.x() + cosine_ * d.y()};
  }

 private:
  Vec2 origin_;
  double cosine_;
  double sine_;
};

}  // namespace palpate
