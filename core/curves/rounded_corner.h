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

  Distance distance(const Vec2& point) const {
    const Vec2 ahead(std::cos(bisector), std::sin(bisector));
    const double cosine = std::cos(half_turn);
    const double sine = std::sin(half_turn);
    const Vec2 away = point - centre;
    const double u = ahead.dot(away);
    const double v = cross(ahead, away);
    const double side = v < 0.0 ? -1.0 : 1.0;
    const double beyond = side * v * cosine - u * sine;  // the end of the arc, along the edge
    Distance result;
    if (beyond > 0.0) {
      const Vec2 normal = cosine * ahead + side * sine * left_of(ahead);
      result.value = normal.dot(away) - radius;
      result.part = side < 0.0 ? Part::FirstEdge : Part::SecondEdge;
      result.gradient << -normal.transpose(), side * beyond, beyond, -1.0;
      return result;
    }
    const double length = away.norm();
    result.value = length - radius;
    result.gradient << (length > 0.0 ? Vec2(-away / length) : Vec2(-ahead)).transpose(), 0.0, 0.0,
        -1.0;
    return result;
  }
};

}  // namespace palpate
