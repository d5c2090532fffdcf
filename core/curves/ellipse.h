// Ellipse: section 3.2.
#pragma once

#include "core/curves/plane_curve.h"

namespace palpate {

/// An ellipse (a cos t, b sin t), a >= b > 0.
struct Ellipse {
  static constexpr CurveClass curve_class = CurveClass::Ellipse;
  static constexpr int parameter_count = 2;
  using Parameters = Eigen::Matrix<double, 2, 1>;

  double a = 1.0;  ///< semi-major axis [m]
  double b = 1.0;  ///< semi-minor axis [m]

  static Ellipse from_parameters(const Parameters& p) { return {p[0], p[1]}; }
  Parameters parameters() const { return {a, b}; }

  /// Whether the parameters are finite and in the range of the canonical form.
  bool is_valid() const;

  Vec2 position(double t) const;
  CurveDerivatives derivatives(double t) const;
  LocalGeometry geometry(double t) const;
  /// Derivative of the position by the shape parameters at fixed t; 2 x 2.
  Eigen::Matrix<double, 2, 2> position_by_parameters(double t) const;

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
  /// Uses kappa and kappa_s, not the tangent angle; well conditioned at the vertices. t is in
  /// (-pi/2, pi/2]; t + pi fits equally well. nullopt if kappa = 0, if a = b or if the geometry is
  /// not finite.
  std::optional<Localisation> localise(const LocalGeometry& local) const;
};

static_assert(PlaneCurve<Ellipse>);

}  // namespace palpate
