// A class as seen from where it was touched: the coordinates in which its prior is stated.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/curves/curve_class.h"

namespace palpate {

/// At most: four of shape and place, then offset and turn. Classes with fewer leave the rest 0.
inline constexpr int kMostCoordinates = 6;
using TouchedVector = Eigen::Matrix<double, kMostCoordinates, 1>;
using TouchedMatrix = Eigen::Matrix<double, kMostCoordinates, kMostCoordinates>;

/// A curve of known class and the place on it that was touched; lengths in touched half extents.
struct TouchedShape {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();  ///< in the order of parameter_letters
  double t = 0.0;                                    ///< of the place
};

/// A parameter's value of a curve of size `scale` over that of size 1: `index` in the order of
/// parameter_letters, or -1 for the curve parameter t.
double parameter_scale(CurveClass curve_class, int index, double scale);

/// A curve in metres, in units of `scale`.
TouchedShape normalised_shape(CurveClass curve_class, const TouchedShape& shape, double scale);

/// Coordinates of shape and place of a class: line 0, circle 1, parabola 2, spline 4, others 3.
int shape_coordinates(CurveClass curve_class);

/// Regular coordinates in which the prior's factors are independent (core/README.md, "The prior"):
///   circle: log radius
///   ellipse, hyperbola: log p and |m| of y^2 = 2 p x + m x^2, tangent's direction at the place
///   parabola: log p, tangent's direction
///   cubical parabola: log L (a = +-1 / L^2), c, place t / L
///   semi-cubical parabola, spline: log L (a = 1 / sqrt(L)), b, place t / sqrt(L) (and c / sqrt(L))
TouchedVector coordinates_of(CurveClass curve_class, const TouchedShape& shape);

/// The inverse; `like` tells what the coordinates do not: the sign of a cubical parabola's a, and
/// the place on a line or circle. nullopt outside of the class.
std::optional<TouchedShape> shape_at(CurveClass curve_class, const TouchedVector& z,
                                     const TouchedShape& like);

/// Width of each coordinate's prior: that of the normal law with its height at the centre. Offset
/// and turn, the same for every class, included.
TouchedVector prior_widths(CurveClass curve_class, const TouchedVector& z);

/// Where the prior is highest.
TouchedVector prior_centre(CurveClass curve_class);

/// The coordinate that the place is; -1 where all places are alike.
int place_coordinate(CurveClass curve_class);

/// log of the length that z[0] is the logarithm of, over the size of the part.
double log_length_over_size(CurveClass curve_class);

/// log of the prior's density over that at its centre.
double log_prior(CurveClass curve_class, const TouchedVector& z);

/// Its derivatives by the coordinates.
TouchedVector log_prior_gradient(CurveClass curve_class, const TouchedVector& z);

/// Along each coordinate -log_prior lies below a parabola that touches it at z. What that rises by
/// over what a normal law of the width does, at most 1: little in a heavy tail, where steps by the
/// law's own curvature would stay.
TouchedVector tail_weights(CurveClass curve_class, const TouchedVector& z);

}  // namespace palpate
