// The order of touches along their part, told by the shortest way through them alone.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// A place on the way.
struct OnWay {
  std::size_t place = 0;  ///< its index
  double along = 0.0;     ///< length of the way to its foot [that of the places]
  /// The least and the greatest direction of the way at the ends of its step there, without jumps
  /// of a turn: where the step has a corner the place may lie on either side of it. [rad]
  double least_angle = 0.0, most_angle = 0.0;
  double angle = 0.0;  ///< at the place's foot [rad]
  double turn = 0.0;   ///< of the step, left positive [rad]
};

/// The places in their order along the way, where there is no doubt of it: through those of them
/// that lie `least_step` or more apart, and at most 128, a way is hardly longer than the shortest
/// tree that joins these, so that it does not go back and forth, and all places lie close to it.
/// nullopt otherwise: where noise is as large as the steps, arms lie close together, or bends are
/// sharp. A closed way is open at its widest gap.
std::optional<std::vector<OnWay>> shortest_way(std::span<const Vec2> places, double least_step);

/// Length of the shortest tree through all points, by Prim's algorithm: no way through them is
/// shorter, in whatever order.
double shortest_tree(std::span<const Vec2> points);

/// In straight steps.
double length_of(std::span<const Vec2> path);

/// How much longer than the shortest tree a way through the points may be that has them in their
/// order: a step back over a tenth of it.
inline constexpr double kDetour = 1.1;

}  // namespace palpate
