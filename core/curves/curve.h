// A curve of any class, and the functions of plane_curve.h for it.
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

/// The curve of `curve_class` with the shape parameters `values`, in the order of
/// parameter_letters; further entries are ignored. nullopt for CurveClass::Unclassified and for
/// parameters outside the range of the canonical form.
std::optional<Curve> make_curve(CurveClass curve_class, const Eigen::Vector3d& values);

CurveClass class_of(const Curve& curve);

/// Shape parameters in the order of parameter_letters; further entries are 0.
Eigen::Vector3d parameters(const Curve& curve);

Vec2 position(const Curve& curve, double t);
CurveDerivatives derivatives(const Curve& curve, double t);
LocalGeometry geometry(const Curve& curve, double t);

/// Derivative of the position by the shape parameters at fixed t. Columns in the order of
/// parameter_letters; further columns are 0.
Eigen::Matrix<double, 2, 3> position_by_parameters(const Curve& curve, double t);

/// Nearest point of the whole curve.
FootPoint foot_point(const Curve& curve, const Vec2& point);

/// Nearest point of the whole curve, unless it is nearer than `distance` by more than `tolerance`
/// [m]. A cubic may have another arm that is nearer: then, of the places that are nearer to the
/// point than those beside them, the one whose distance is closest to `distance`.
FootPoint foot_at_distance(const Curve& curve, const Vec2& point, double distance,
                           double tolerance);

/// The foot that Newton's method reaches from `t_start` in a few steps; the nearest point of the
/// whole curve where that fails. For callers that track t from sample to sample
/// (core/curves/foot_point.h).
FootPoint foot_point_near(const Curve& curve, const Vec2& point, double t_start);

/// Signed arc length from t0 to t1. [m]
double arc_length(const Curve& curve, double t0, double t1);
/// The t at the signed arc length s [m] from t0.
double parameter_at_arc_length(const Curve& curve, double t0, double s);
ParameterDomain domain(const Curve& curve);

/// The place on the curve, and the direction of travel, with this local geometry (signed by
/// travel). The comment at each class's `localise` says what it uses and when it returns nullopt.
std::optional<Localisation> localise(const Curve& curve, const LocalGeometry& local);

/// The pose world_T_curve that puts `place` on `world_point` [m] and its direction of travel along
/// `world_tangent_angle` [rad].
Pose2 pose_from_contact(const Curve& curve, const Localisation& place, const Vec2& world_point,
                        double world_tangent_angle);

}  // namespace palpate
