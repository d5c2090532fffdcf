// Starting curves of the polynomial classes, by the direction of the axis.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/given/starts/given_starts.h"

namespace palpate {

/// Curves of the class near `points` whose sum of squares has a minimum, the lower ones first. For
/// a given direction of the axis a parabola or cubical parabola is a graph with linear
/// coefficients, so a scan of the directions meets the minima, as far apart as the part is slim.
/// For a given vertex besides, an arm of a semi-cubical parabola or of a spline is one too: here
/// the points are taken to lie on one arm. Empty for the other classes. The points have about unit
/// extent.
///
/// `radii`: of the round tips whose centres the points are, taken off along the normals of the
/// lowest such curve, to either side; 0 where there is no tip.
std::vector<GivenStart> starts_by_axis(CurveClass curve_class, std::span<const Vec2> points,
                                       std::span<const double> radii);

}  // namespace palpate
