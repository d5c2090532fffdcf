// Finds the order of single touches along the part from the shortest way through them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// A place on the way.
struct OnWay {
  std::size_t place = 0;  ///< index of the place
  double along = 0.0;     ///< length of the way to the place's foot, in the unit of the places
  /// Smallest and largest direction of the way at the ends of the step with the foot, unwrapped. At
  /// a corner of the step the place may lie on either side of it. [rad]
  double least_angle = 0.0, most_angle = 0.0;
  double angle = 0.0;  ///< at the place's foot [rad]
  double turn = 0.0;   ///< of the step, left positive [rad]
  /// Whether the places leave a gap before it: over that the way may as well go on from another
  /// end.
  bool after_gap = false;
};

/// The places in their order along the way, if that is beyond doubt. The way runs through at most
/// 128 places that are `least_step` or more apart. It must be at most kDetour times as long as the
/// shortest tree through these, so that it does not go back and forth, and all places must lie
/// close to it. nullopt otherwise: the noise is as large as the steps, arms lie close together, or
/// bends are sharp. A closed way is cut at its widest gap.
std::optional<std::vector<OnWay>> shortest_way(std::span<const Vec2> places, double least_step);

/// Length of the shortest tree through all points (Prim's algorithm): a lower bound for any way
/// through them.
double shortest_tree(std::span<const Vec2> points);

/// Length of a path of straight steps.
double length_of(std::span<const Vec2> path);

/// Largest length of a way in units of the shortest tree through the same points. A longer way goes
/// back and forth, by a tenth of its length or more.
inline constexpr double kDetour = 1.1;

}  // namespace palpate
