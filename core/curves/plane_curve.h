// What every curve class of core/curves/ offers, asked by one common set of names (a concept and a
// std::variant: no virtual call per sample).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <optional>

#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate {

/// Position and its first three derivatives with respect to the curve parameter t. [m]
struct CurveDerivatives {
  Vec2 position;
  Vec2 first;
  Vec2 second;
  Vec2 third;
};

/// Differential geometry at a point, signed by increasing t.
struct LocalGeometry {
  double tangent_angle = 0.0;  ///< atan2(y', x') in (-pi, pi] [rad]
  double kappa = 0.0;          ///< curvature, (1) [1/m]
  double kappa_s = 0.0;        ///< derivative of the curvature by arc length, (2) [1/m^2]
};

/// Nearest point of a curve to a given point. Of several equally near, any one. For a point that is
/// not finite: t = 0 and distance = +infinity.
struct FootPoint {
  double t = 0.0;         ///< curve parameter, in the domain
  Vec2 position;          ///< on the curve [m]
  double distance = 0.0;  ///< signed: positive to the left of increasing t [m]
};

/// What the derivative of (C(t) - p) . C'(t) must have at least of the square of the speed for
/// Newton's method to follow the foot of p: at the centre of curvature, where that is no minimum of
/// the distance any more, it is 0, and Newton's step is at most ten of Gauss and Newton's.
inline constexpr double kLeastFootSlope = 0.1;

/// A place on a curve, and how it was travelled. It says where a measurement fits best, not whether
/// it fits: that is for the caller to see from geometry(t).
struct Localisation {
  double t = 0.0;
  bool along_increasing_t = true;
};

inline bool is_finite(const LocalGeometry& g) {
  return std::isfinite(g.tangent_angle) && std::isfinite(g.kappa) && std::isfinite(g.kappa_s);
}

/// The place, or nullopt where t left the range of a double.
inline std::optional<Localisation> finite_place(double t, bool along_increasing_t) {
  return std::isfinite(t) ? std::optional(Localisation{t, along_increasing_t}) : std::nullopt;
}

/// The same measurement, travelled the other way.
inline LocalGeometry reversed(const LocalGeometry& g) {
  return {wrap_angle(g.tangent_angle + kPi), -g.kappa, g.kappa_s};
}

/// Closed range of the curve parameter over which a class is defined; infinite where unbounded.
struct ParameterDomain {
  double lower = 0.0;
  double upper = 0.0;
  double period = 0.0;  ///< 0 = not periodic
};

/// A curve in its canonical frame. Parameters t, lengths s and shape parameters must be finite;
/// foot_point and localise take any number. No function allocates. `Parameters` is a fixed-size
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
