// The directions in which the axis of a polynomial class is looked for.
#pragma once

#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// Directions of the axis to be looked at, in increasing order, over `turn`: a whole turn, or half
/// of one where a class looks the same along either end of its axis. The class stays the same when
/// the plane is stretched, and of points as wide as long a valley is some degrees wide. So the
/// lines across the axis, along which a graph's value is measured, are evenly spread both as they
/// are and after the points have been stretched to be as wide as long: of a slim part, whose graph
/// rises along it, a valley is as narrow as the part is slim. [rad]
std::vector<double> axis_directions(std::span<const Vec2> points, double turn);

}  // namespace palpate
