// What can be touched in a scene: any curve class, a closed spline, or a shape of no class.
#pragma once

#include <optional>
#include <variant>

#include "core/curves/curve.h"
#include "core/part/closed_spline.h"
#include "sim/shape_point.h"
#include "sim/unclassified_shapes.h"

namespace palpate::sim {

using Shape = std::variant<Curve, ClosedSpline, Superellipse, Sinusoid, LogSpiral>;

/// Position, first and second derivative with respect to the curve parameter. [m]
ShapePoint point_at(const Shape& shape, double t);

/// Signed by increasing t. [1/m]
double curvature(const ShapePoint& point);

/// The t at signed arc length s [m] from t0.
double parameter_at_arc_length(const Shape& shape, double t0, double s);

/// A shape of one of the classes, and where its canonical frame lies.
struct ClassifiedPiece {
  Curve curve;
  Pose2 shape_T_curve;
};

/// What the piece from t0 to t1 is; nullopt where it is of no class, or runs over a joint.
std::optional<ClassifiedPiece> classified_piece(const Shape& shape, double t0, double t1);

}  // namespace palpate::sim
