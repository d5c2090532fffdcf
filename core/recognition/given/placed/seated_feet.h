// The feet of all points on a placed curve.
#pragma once

#include <span>

#include "core/recognition/given/placed/orthogonal_squares.h"
#include "core/recognition/given/placed/placed_curve.h"

namespace palpate {

/// Sets every foot to the nearest point of the whole curve, those of strokes in an order in which a
/// probe can have gone there (stroke_feet.h). False if the shape is outside the class.
bool seat_globally(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points);

/// Moves every foot to the nearest place of the curve beside it. False if the shape is outside the
/// class.
bool seat_nearby(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points);

/// Sets every foot to the nearest point of the arm where t has that sign, of a curve whose points
/// are (t^2, ...). False if one has none there, or if the shape is outside the class.
bool seat_on_arm(int arm, PlacedCurve<double>* placed,
                 std::span<const WeighedPoint<double>> points);

/// True if t has that sign at all feet.
bool is_on_arm(int arm, const PlacedCurve<double>& placed);

}  // namespace palpate
