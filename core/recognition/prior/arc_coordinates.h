// The spline as an arc: the terms of Taylor's series at the place that was touched.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/recognition/prior/student_law.h"
#include "core/recognition/prior/touched_coordinates.h"

namespace palpate {

/// A cubic arc in the frame of the touched place's tangent, by what is nearly its arc length:
/// position = (s, 0) + s^2 / 2 (z0, z1) + s^3 / 6 (z2, z3).
using ArcCoordinates = Eigen::Vector4d;

/// `spline`: a, b, c and the place.
ArcCoordinates arc_coordinates_of(const TouchedShape& spline);

/// Whether the arc, travelled so, is a spline: parabolas and cubical parabolas are not, and on the
/// far side of these the spline's t increases the other way.
bool is_spline(const ArcCoordinates& z);

/// The inverse. nullopt where the arc, travelled so, is no spline, or so near to a cubical parabola
/// that double precision does not hold its vertex. Lengths in touched half extents.
std::optional<TouchedShape> spline_at(const ArcCoordinates& z);

/// The law of each coordinate, in touched half extents: core/README.md, "The prior".
StudentLaw law_of_arc(int k);

/// Whether the arc's inflections are at least half as far from the vertex as the place is. The
/// nearer they are to the vertex, the more is c told by its square alone, and an arc's coordinates
/// with it. `place_from_vertex`: a t; `bend`: a c.
bool is_seen_as_arc(double place_from_vertex, double bend);

}  // namespace palpate
