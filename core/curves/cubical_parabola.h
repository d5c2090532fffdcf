// Cubical parabola: section 4.1, (36).
#pragma once

#include "core/curves/plane_curve.h"

namespace palpate {

/// A cubical parabola (t, a t^3 + c t), a != 0.
struct CubicalParabola {
  static constexpr CurveClass curve_class = CurveClass::CubicalParabola;
  static constexpr int parameter_count = 2;
  using Parameters = Eigen::Matrix<double, 2, 1>;

  double a = 1.0;  ///< [1/m^2]
  double c = 0.0;  ///< slope at the inflection [1]

  static CubicalParabola from_parameters(const Parameters& p) { return {p[0], p[1]}; }
  Parameters parameters() const { return {a, c}; }

  /// Whether the parameters are finite and in the range of the canonical form.
  bool is_valid() const;

  Vec2 position(double t) const { return {t, (a * t * t + c) * t}; }
  CurveDerivatives derivatives(double t) const {
    return {position(t), {1.0, 3.0 * a * t * t + c}, {0.0, 6.0 * a * t}, {0.0, 6.0 * a}};
  }
  LocalGeometry geometry(double t) const;
  /// Derivative of the position by the shape parameters at fixed t; 2 x 2.
  Eigen::Matrix<double, 2, 2> position_by_parameters(double t) const {
    Eigen::Matrix<double, 2, 2> m;
    m << 0.0, 0.0, t * t * t, t;
    return m;
  }

  /// Nearest point of the whole curve.
  FootPoint foot_point(const Vec2& point) const;

  /// |C'(t)| [m]. Without std::hypot, whose protection from overflow makes quadrature several times
  /// slower.
  double speed(double t) const;
  /// Arc length from t0 to t1, negative if t1 < t0. [m]
  double arc_length(double t0, double t1) const;
  /// The t at signed arc length s [m] from t0.
  double parameter_at_arc_length(double t0, double s) const;

  ParameterDomain domain() const;

  /// The place and direction of travel with this local geometry, signed by travel (section 5.3).
  /// Needs the tangent angle in the canonical frame. nullopt if that angle is vertical, which it is
  /// nowhere on the curve, or if the geometry is not finite.
  std::optional<Localisation> localise(const LocalGeometry& local) const;
};

static_assert(PlaneCurve<CubicalParabola>);

}  // namespace palpate
