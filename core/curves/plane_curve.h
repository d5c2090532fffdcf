// The interface that every curve class of core/curves/ has. It is a C++20 concept, and curve.h
// holds all classes in one std::variant, so that no sample costs a virtual call.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>

#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate {

/// Position and its first three derivatives by the curve parameter t. [m]
struct CurveDerivatives {
  Vec2 position;
  Vec2 first;
  Vec2 second;
  Vec2 third;
};

/// Differential geometry at a point, for travel along increasing t.
struct LocalGeometry {
  double tangent_angle = 0.0;  ///< atan2(y', x') in (-pi, pi] [rad]
  double kappa = 0.0;          ///< curvature, (1) [1/m]
  double kappa_s = 0.0;        ///< derivative of the curvature by arc length, (2) [1/m^2]
};

/// Nearest point of a curve to a given point. If several points are equally near, any one of them.
/// If the given point is not finite: t = 0 and distance = +infinity.
struct FootPoint {
  double t = 0.0;         ///< curve parameter, in the domain
  Vec2 position;          ///< on the curve [m]
  double distance = 0.0;  ///< positive to the left of increasing t [m]
};

/// Follow a foot by Newton's method only where d/dt of (C(t) - p) . C'(t) is at least this fraction
/// of the squared speed |C'|^2. The derivative is 0 where p is a centre of curvature: from there on
/// the foot is no minimum of the distance. This limit keeps a Newton step within ten times a
/// Gauss-Newton step.
inline constexpr double kLeastFootSlope = 0.1;

/// A place on a curve and the direction of travel there. It is the place that fits a measurement
/// best. It does not say whether the measurement fits: compare it with geometry(t).
struct Localisation {
  double t = 0.0;
  bool along_increasing_t = true;
};

inline bool is_finite(const LocalGeometry& g) {
  return std::isfinite(g.tangent_angle) && std::isfinite(g.kappa) && std::isfinite(g.kappa_s);
}

/// The place, or nullopt if t is not finite.
inline std::optional<Localisation> finite_place(double t, bool along_increasing_t) {
  return std::isfinite(t) ? std::optional(Localisation{t, along_increasing_t}) : std::nullopt;
}

/// The same measurement for the opposite direction of travel.
inline LocalGeometry reversed(const LocalGeometry& g) {
  return {wrap_angle(g.tangent_angle + kPi), -g.kappa, g.kappa_s};
}

/// Closed range of the curve parameter; the bounds are infinite for an unbounded curve.
struct ParameterDomain {
  double lower = 0.0;
  double upper = 0.0;
  double period = 0.0;  ///< 0 = not periodic
};
inline constexpr ParameterDomain kUnbounded{-std::numeric_limits<double>::infinity(),
                                            std::numeric_limits<double>::infinity(), 0.0};

/// A curve in its canonical frame. Parameters t, lengths s and shape parameters must be finite;
/// foot_point and localise accept any numbers. No function allocates. `Parameters` is a fixed-size
/// Eigen vector in the order of parameter_letters(curve_class).
template <typename C>
concept PlaneCurve = requires(const C& curve, double t, const Vec2& point,
                              const typename C::Parameters& parameters) {
  { C::curve_class } -> std::convertible_to<CurveClass>;
  { C::parameter_count } -> std::convertible_to<int>;
  { C::from_parameters(parameters) } -> std::same_as<C>;
  { curve.parameters() } -> std::same_as<typename C::Parameters>;
  { curve.position(t) } -> std::same_as<Vec2>;
  { curve.derivatives(t) } -> std::same_as<CurveDerivatives>;
  { curve.geometry(t) } -> std::same_as<LocalGeometry>;
  { curve.position_by_parameters(t) } -> std::same_as<Eigen::Matrix<double, 2, C::parameter_count>>;
  { curve.foot_point(point) } -> std::same_as<FootPoint>;
  { curve.arc_length(t, t) } -> std::same_as<double>;
  { curve.parameter_at_arc_length(t, t) } -> std::same_as<double>;
  { curve.domain() } -> std::same_as<ParameterDomain>;
  { curve.localise(LocalGeometry{}) } -> std::same_as<std::optional<Localisation>>;
  { curve.is_valid() } -> std::same_as<bool>;
};

}  // namespace palpate
