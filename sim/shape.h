// The shape of an object in a scene: a curve of any class, a closed spline, or a shape of no class.
#pragma once

#include <optional>
#include <variant>

#include "core/curves/curve.h"
#include "core/part/closed_spline.h"
#include "sim/shape_point.h"
#include "sim/unclassified_shapes.h"

namespace palpate::sim {

using Shape = std::variant<Curve, ClosedSpline, Superellipse, Sinusoid, LogSpiral>;

/// Position, first and second derivative by the curve parameter. [m]
ShapePoint point_at(const Shape& shape, double t);

/// Signed by increasing t. [1/m]
double curvature(const ShapePoint& point);

/// The t at signed arc length s from t0. [m]
double parameter_at_arc_length(const Shape& shape, double t0, double s);

/// A curve of one of the classes, and the pose of its canonical frame.
struct ClassifiedPiece {
  Curve curve;
  Pose2 shape_T_curve;
};

/// The curve between t0 and t1; nullopt if it is of no class or crosses a joint.
std::optional<ClassifiedPiece> classified_piece(const Shape& shape, double t0, double t1);

}  // namespace palpate::sim
