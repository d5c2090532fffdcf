// What every curve class of core/curves/ offers, asked by one common set of names (a concept and a
// std::variant: no virtual call per sample).
#pragma once

#include <Eigen/Core>
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

/// Nearest point of a curve to a given point.
struct FootPoint {
  double t = 0.0;         ///< curve parameter
  Vec2 position;          ///< on the curve [m]
  double distance = 0.0;  ///< signed: positive to the left of increasing t [m]
};

/// A place on a curve, and how it was travelled.
struct Localisation {
  double t = 0.0;
  bool along_increasing_t = true;
};

/// Closed range of the curve parameter over which a class is defined; infinite where unbounded.
struct ParameterDomain {
  double lower = 0.0;
  double upper = 0.0;
  double period = 0.0;  ///< 0 = not periodic
};

/// A curve in its canonical frame. `Parameters` is a fixed-size Eigen vector in the order of
/// parameter_letters(curve_class).
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
  {
    curve.position_by_parameters(t)
  } -> std::same_as<Eigen::Matrix<double, 2, C::parameter_count>>;
  { curve.foot_point(point) } -> std::same_as<FootPoint>;
  { curve.arc_length(t, t) } -> std::same_as<double>;
  { curve.parameter_at_arc_length(t, t) } -> std::same_as<double>;
  { curve.domain() } -> std::same_as<ParameterDomain>;
  { curve.localise(LocalGeometry{}) } -> std::same_as<std::optional<Localisation>>;
  { curve.is_valid() } -> std::same_as<bool>;
};

}  // namespace palpate
