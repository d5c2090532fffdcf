// A window's coordinates in which the circle through its ends and its middle is a straight line.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/curves/pose2.h"
#include "core/local/local_estimate.h"
#include "core/local/stream/node_pyramid.h"

namespace palpate {

/// The Moebius map z -> w = z / (1 + i c z), z counted from `middle` along `tangent`, c half the
/// circle's curvature. It keeps angles and the middle's surroundings, straightens the circle, and
/// moves a point that the circle has turned to by phi to (2 / kappa) tan(phi / 2).
/// core/README.md, "The sliding window".
class Straightening {
 public:
  /// The circle of the first node, the last one, and the one beside the middle of the chord between
  /// them. A straight line where these are no three points.
  explicit Straightening(std::span<const PathNode> nodes);

  /// Whether the circle turns by more than `angle` from its middle to either end.
  bool turns_beyond(double angle) const;

  /// Of the same middle and tangent, by a circle without curvature: a rotation and a shift.
  Straightening left_bent() const {
    Straightening same = *this;
    same.half_kappa_ = 0.0;
    return same;
  }

  struct Point {
    Vec2 w_m = Vec2::Zero();
    /// |dz/dw|: cos^2(phi / 2) on the circle. Lengths and noise are 1 / shrink as large in w.
    double shrink = 1.0;
  };
  Point to_line(const Vec2& world) const {
    const Vec2 d = world - middle_;
    const double x = tangent_.dot(d);
    const double y = cross(tangent_, d);
    if (half_kappa_ == 0.0) {
      return {Vec2(x, y), 1.0};
    }
    const double cx = half_kappa_ * x;
    const double real = 1.0 - half_kappa_ * y;
    const double shrink = real * real + cx * cx;
    return {Vec2(x, y - half_kappa_ * (x * x + y * y)) / shrink, shrink};
  }

  /// An estimate in w, with its covariance, as one in the world. With P = g'' / g' of the inverse
  /// g(w) = w / (1 - i c w), which for a Moebius map has P' = P^2 / 2, and tau the unit tangent,
  ///   kappa_z = (kappa_w + Im(P tau)) / |g'|,   kappa_s,z = kappa_s,w / |g'|^2.
  LocalEstimate to_world(const LocalEstimate& at_w) const;

  /// Arc length between two points of the straightened circle, by their abscissae.
  double arc_m(double from_x_m, double to_x_m) const;

  double kappa() const { return 2.0 * half_kappa_; }

 private:
  Vec2 middle_ = Vec2::Zero();
  Vec2 tangent_ = Vec2::UnitX();
  double half_kappa_ = 0.0;
  double least_shrink_ = 1.0;  ///< of the ends
};

}  // namespace palpate
