// Two straight edges that meet in a fillet.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/curves/pose2.h"

namespace palpate {

/// The curve of a corner whose edges are tangents of one arc; of a tip that rolls about it as well.
/// `half_turn` in (0, pi / 2]: the arc takes twice as much, from the one edge's direction to the
/// other's.
struct RoundedCorner {
  using Row = Eigen::Matrix<double, 1, 5>;

  Vec2 centre = Vec2::Zero();  ///< of the arc
  double bisector = 0.0;       ///< direction from the centre to the middle of the arc [rad]
  double half_turn = 0.0;      ///< [rad]
  double radius = 0.0;         ///< of the arc

  enum class Part { FirstEdge, Arc, SecondEdge };
  struct Distance {
    double value = 0.0;  ///< from the curve, positive outside
    Part part = Part::Arc;
    /// By the centre's x and y, the bisector, the half turn and the radius.
    Row gradient = Row::Zero();
  };

  Distance distance(const Vec2& point) const;

  /// Of the curve at its nearest point, unit, counter-clockwise about the arc.
  Vec2 tangent(const Vec2& point) const {
    return -left_of(distance(point).gradient.head<2>().transpose().eval());
  }
};

/// The same for many points: sines and cosines are taken once.
class RoundedCornerAxes {
 public:
  explicit RoundedCornerAxes(const RoundedCorner& corner)
      : centre_(corner.centre),
        ahead_(std::cos(corner.bisector), std::sin(corner.bisector)),
        cosine_(std::cos(corner.half_turn)),
        sine_(std::sin(corner.half_turn)),
        radius_(corner.radius) {}

  /// +1 on the second edge's side of the bisector, -1 on the first's.
  double side_of(const Vec2& point) const {
    return cross(ahead_, point - centre_) < 0.0 ? -1.0 : 1.0;
  }

  /// RoundedCorner::Distance::value, from the arc and the edge on that side alone.
  double distance(const Vec2& point, double side) const {
    const Seen at = seen(point, side);
    return at.beyond > 0.0 ? cosine_ * at.u + sine_ * at.side * at.v - radius_
                           : (point - centre_).norm() - radius_;
  }

  RoundedCorner::Distance with_gradient(const Vec2& point) const {
    return with_gradient(point, side_of(point));
  }

  RoundedCorner::Distance with_gradient(const Vec2& point, double side) const {
    const Seen at = seen(point, side);
    const Vec2 away = point - centre_;
    RoundedCorner::Distance result;
    if (at.beyond > 0.0) {
      const Vec2 normal = cosine_ * ahead_ + at.side * sine_ * left_of(ahead_);
      result.value = normal.dot(away) - radius_;
      result.part =
          at.side < 0.0 ? RoundedCorner::Part::FirstEdge : RoundedCorner::Part::SecondEdge;
      result.gradient << -normal.transpose(), at.side * at.beyond, at.beyond, -1.0;
      return result;
    }
    const double length = away.norm();
    result.value = length - radius_;
    result.gradient << (length > 0.0 ? Vec2(-away / length) : Vec2(-ahead_)).transpose(), 0.0, 0.0,
        -1.0;
    return result;
  }

 private:
  /// A point from the centre, along and across the bisector.
  struct Seen {
    double u, v, side;
    double beyond;  ///< the end of the arc, along the edge
  };

  Seen seen(const Vec2& point, double side) const {
    const Vec2 away = point - centre_;
    const double u = ahead_.dot(away);
    const double v = cross(ahead_, away);
    return {u, v, side, side * v * cosine_ - u * sine_};
  }

  Vec2 centre_;
  Vec2 ahead_;
  double cosine_;
  double sine_;
  double radius_;
};

inline RoundedCorner::Distance RoundedCorner::distance(const Vec2& point) const {
  return RoundedCornerAxes(*this).with_gradient(point);
}

}  // namespace palpate
