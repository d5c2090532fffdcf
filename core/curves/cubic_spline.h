// Cubic spline segment: section 4.3, (38).
#pragma once

#include "core/curves/plane_curve.h"

namespace palpate {

/// A cubic spline segment (t^2, a t^3 + b t^2 + c t), a > 0, c != 0.
struct CubicSpline {
  static constexpr CurveClass curve_class = CurveClass::CubicSpline;
  static constexpr int parameter_count = 3;
  using Parameters = Eigen::Matrix<double, 3, 1>;

  double a = 1.0;  ///< [1/sqrt(m)]
  double b = 0.0;  ///< slope term [1]
  double c = 1.0;  ///< [sqrt(m)]

  static CubicSpline from_parameters(const Parameters& p) { return {p[0], p[1], p[2]}; }
  Parameters parameters() const { return {a, b, c}; }
  /// The c > 0 of a bend at t = 0 of that radius, c^2 / 2. [sqrt(m)]
  static double c_of_bend(double radius_m);

  /// Whether the parameters are finite and in the range of the canonical form.
  bool is_valid() const;

  Vec2 position(double t) const { return {t * t, ((a * t + b) * t + c) * t}; }
  CurveDerivatives derivatives(double t) const {
    return {position(t),
            {2.0 * t, (3.0 * a * t + 2.0 * b) * t + c},
            {2.0, 6.0 * a * t + 2.0 * b},
            {0.0, 6.0 * a}};
  }
  LocalGeometry geometry(double t) const;
  /// Derivative of the position by the shape parameters at fixed t; 2 x 3.
  Eigen::Matrix<double, 2, 3> position_by_parameters(double t) const {
    Eigen::Matrix<double, 2, 3> m;
    m << 0.0, 0.0, 0.0, t * t * t, t * t, t;
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
  /// Needs the tangent angle in the canonical frame. Two places have that slope; kappa and kappa_s
  /// choose between them. For c > 0 the curve does not reach every slope: such a slope gives the
  /// nearest inflection. nullopt if the geometry is not finite.
  std::optional<Localisation> localise(const LocalGeometry& local) const;
};

static_assert(PlaneCurve<CubicSpline>);

}  // namespace palpate
