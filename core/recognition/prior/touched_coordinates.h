// Coordinates of a class relative to the place that was touched; its prior is defined in them
// (touched_prior.h).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/curves/curve_class.h"

namespace palpate {

/// Most coordinates: four of shape and place, then offset and turn. Classes with fewer leave the
/// rest 0.
inline constexpr int kMostCoordinates = 6;
using TouchedVector = Eigen::Matrix<double, kMostCoordinates, 1>;
using TouchedMatrix = Eigen::Matrix<double, kMostCoordinates, kMostCoordinates>;

/// A curve of known class and the touched place on it; lengths in touched half extents.
struct TouchedShape {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();  ///< in the order of parameter_letters
  double t = 0.0;                                    ///< curve parameter of the place
};

/// One set of coordinates: a class's own, or those of a spline as an arc (arc_coordinates.h).
struct Chart {
  CurveClass curve_class = CurveClass::Unclassified;
  bool as_arc = false;
};

/// Ratio of a parameter of a curve of size `scale` to that of the same curve of size 1. `index`: in
/// the order of parameter_letters, or -1 for the curve parameter t.
double parameter_scale(CurveClass curve_class, int index, double scale);

/// Converts a curve from metres to units of `scale`.
TouchedShape normalised_shape(CurveClass curve_class, const TouchedShape& shape, double scale);

/// Number of coordinates of shape and place: line 0, circle 1, parabola 2, spline 4, others 3.
int shape_coordinates(CurveClass curve_class);

/// Regular coordinates. The prior of parts touched about their bend is a product of independent
/// factors in them, but an ellipse's size and directions, which depend on m (core/README.md, "The
/// prior"):
///   circle: log radius
///   ellipse, hyperbola: log p and |m| of y^2 = 2 p x + m x^2, tangent's direction at the place
///   parabola: log p, tangent's direction
///   cubical parabola: log L (a = +-1 / L^2), c, place t / L
///   semi-cubical parabola, spline: log L (a = 1 / sqrt(L)), b, place t / sqrt(L) (and c / sqrt(L))
/// and for half of the spline's prior those of an arc.
TouchedVector coordinates_of(Chart chart, const TouchedShape& shape);

/// The inverse. `like` supplies what the coordinates do not contain: the sign of a cubical
/// parabola's a, and the place on a line or circle. nullopt outside the class.
std::optional<TouchedShape> shape_at(Chart chart, const TouchedVector& z, const TouchedShape& like);

/// Index of the coordinate of the place; -1 if all places are alike.
int place_coordinate(CurveClass curve_class);

}  // namespace palpate
