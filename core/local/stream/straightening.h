// Coordinates in which a circle through a window becomes a straight line.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/curves/pose2.h"
#include "core/local/local_estimate.h"
#include "core/local/stream/node_pyramid.h"

namespace palpate {

/// The Moebius map z -> w = z / (1 + i c z). z is measured from `middle` along `tangent`; c is half
/// the curvature of the circle. The map preserves angles, is the identity to first order at the
/// middle, and turns the circle into a straight line. A point where the circle has turned by phi
/// goes to (2 / kappa) tan(phi / 2). core/README.md, "The sliding window".
class Straightening {
 public:
  /// Uses the circle through the first node, the last node and the node nearest to the bisector of
  /// the chord between them; a straight line if these are not three distinct points.
  explicit Straightening(std::span<const PathNode> nodes);

  /// Whether the circle turns by more than `angle` [rad] from its middle to either end.
  bool turns_beyond(double angle) const;

  /// The same middle and tangent without curvature: only a rotation and a shift.
  Straightening left_bent() const {
    Straightening same = *this;
    same.half_kappa_ = 0.0;
    return same;
  }

  struct Point {
    Vec2 w_m = Vec2::Zero();
    /// |dz/dw|: cos^2(phi / 2) on the circle. Lengths and noise in w are 1 / shrink times as large.
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

  /// Converts an estimate in w, with its covariance, into one in the world. With P = g'' / g' of
  /// the inverse map g(w) = w / (1 - i c w), for which P' = P^2 / 2, and the unit tangent tau,
  ///   kappa_z = (kappa_w + Im(P tau)) / |g'|,   kappa_s,z = kappa_s,w / |g'|^2.
  LocalEstimate to_world(const LocalEstimate& at_w) const;

  /// Arc length between two points of the circle, given their abscissae in w. [m]
  double arc_m(double from_x_m, double to_x_m) const;

  double kappa() const { return 2.0 * half_kappa_; }

 private:
  Vec2 middle_ = Vec2::Zero();
  Vec2 tangent_ = Vec2::UnitX();
  double half_kappa_ = 0.0;
  double least_shrink_ = 1.0;  ///< at the ends
};

}  // namespace palpate
