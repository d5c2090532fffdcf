// Any class, asked by one set of names.
#pragma once

#include <optional>
#include <variant>

#include "core/curves/circle.h"
#include "core/curves/cubic_spline.h"
#include "core/curves/cubical_parabola.h"
#include "core/curves/ellipse.h"
#include "core/curves/hyperbola.h"
#include "core/curves/line.h"
#include "core/curves/parabola.h"
#include "core/curves/semi_cubical_parabola.h"

namespace palpate {

using Curve = std::variant<Line, Circle, Ellipse, Parabola, Hyperbola, CubicalParabola,
                           SemiCubicalParabola, CubicSpline>;

/// The curve of that class with `values` in the order of parameter_letters (the rest is ignored);
/// nullopt for CurveClass::Unclassified and for parameters out of the canonical form's range.
std::optional<Curve> make_curve(CurveClass curve_class, const Eigen::Vector3d& values);

CurveClass class_of(const Curve& curve);

/// In the order of parameter_letters; the rest is 0.
Eigen::Vector3d parameters(const Curve& curve);

Vec2 position(const Curve& curve, double t);
CurveDerivatives derivatives(const Curve& curve, double t);
LocalGeometry geometry(const Curve& curve, double t);

/// Columns in the order of parameter_letters; the rest is 0.
Eigen::Matrix<double, 2, 3> position_by_parameters(const Curve& curve, double t);

/// Nearest point of the whole curve.
FootPoint foot_point(const Curve& curve, const Vec2& point);

/// The foot whose basin `t_start` lies in, in a few steps; the global one where that fails. For
/// callers who track t from sample to sample (core/curves/foot_point.h).
FootPoint foot_point_near(const Curve& curve, const Vec2& point, double t_start);

/// Signed arc length from t0 to t1. [m]
double arc_length(const Curve& curve, double t0, double t1);
/// The t at signed arc length s from t0.
double parameter_at_arc_length(const Curve& curve, double t0, double s);
ParameterDomain domain(const Curve& curve);

/// Where on the curve, and in which direction of travel, the local geometry (signed by travel) is
/// found. What it needs and when there is none: each class's `localise`.
std::optional<Localisation> localise(const Curve& curve, const LocalGeometry& local);

/// The pose world_T_curve that puts a place of the curve on a world point with the world direction
/// of travel.
Pose2 pose_from_contact(const Curve& curve, const Localisation& place, const Vec2& world_point,
                        double world_tangent_angle);

}  // namespace palpate
