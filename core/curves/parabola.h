// Parabola: section 3.1.
#pragma once

#include "core/curves/plane_curve.h"

namespace palpate {

/// A parabola (a t^2, 2 a t), a > 0.
struct Parabola {
  static constexpr CurveClass curve_class = CurveClass::Parabola;
  static constexpr int parameter_count = 1;
  using Parameters = Eigen::Matrix<double, 1, 1>;

  double a = 1.0;  ///< focal distance [m]

  static Parabola from_parameters(const Parameters& p) { return {p[0]}; }
  Parameters parameters() const { return Parameters(a); }

  /// Whether the parameters are finite and in the range of the canonical form.
  bool is_valid() const;

  Vec2 position(double t) const { return {a * t * t, 2.0 * a * t}; }
  CurveDerivatives derivatives(double t) const {
    return {{a * t * t, 2.0 * a * t}, {2.0 * a * t, 2.0 * a}, {2.0 * a, 0.0}, {0.0, 0.0}};
  }
  LocalGeometry geometry(double t) const;
  /// Derivative of the position by the shape parameters at fixed t; 2 x 1.
  Eigen::Matrix<double, 2, 1> position_by_parameters(double t) const;

  /// Nearest point of the whole curve.
  FootPoint foot_point(const Vec2& point) const;

  /// Arc length from t0 to t1, negative if t1 < t0. [m]
  double arc_length(double t0, double t1) const;
  /// The t at signed arc length s [m] from t0.
  double parameter_at_arc_length(double t0, double s) const;

  ParameterDomain domain() const;

  /// The place and direction of travel with this local geometry, signed by travel (section 5.3): t
  /// = kappa_s / (3 kappa^2). Does not use the tangent angle. nullopt if kappa = 0 or if the
  /// geometry is not finite.
  std::optional<Localisation> localise(const LocalGeometry& local) const;
};

static_assert(PlaneCurve<Parabola>);

}  // namespace palpate
