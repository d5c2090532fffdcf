// Semi-cubical parabola: section 4.2, (37).
#pragma once

#include "core/curves/plane_curve.h"

namespace palpate {

/// A semi-cubical parabola (t^2, a t^3 + b t^2), a > 0, with its cusp at t = 0.
struct SemiCubicalParabola {
  static constexpr CurveClass curve_class = CurveClass::SemiCubicalParabola;
  static constexpr int parameter_count = 2;
  using Parameters = Eigen::Matrix<double, 2, 1>;

  double a = 1.0;  ///< [1/sqrt(m)]
  double b = 0.0;  ///< slope at the cusp [1]

  static SemiCubicalParabola from_parameters(const Parameters& p) { return {p[0], p[1]}; }
  Parameters parameters() const { return {a, b}; }

  /// Whether the parameters are finite and in the range of the canonical form.
  bool is_valid() const;

  Vec2 position(double t) const { return {t * t, (a * t + b) * t * t}; }
  CurveDerivatives derivatives(double t) const {
    return {position(t),
            {2.0 * t, (3.0 * a * t + 2.0 * b) * t},
            {2.0, 6.0 * a * t + 2.0 * b},
            {0.0, 6.0 * a}};
  }
  LocalGeometry geometry(double t) const;
  /// Derivative of the position by the shape parameters at fixed t; 2 x 2.
  Eigen::Matrix<double, 2, 2> position_by_parameters(double t) const {
    Eigen::Matrix<double, 2, 2> m;
    m << 0.0, 0.0, t * t * t, t * t;
    return m;
  }

  /// Nearest point of the whole curve. The cusp has no normal, but may be the nearest point like
  /// any other. The distance is negative between the arms and positive everywhere else; it is
  /// continuous around the cusp.
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
  /// Needs the tangent angle in the canonical frame. The sign of kappa gives the direction of
  /// travel; with it, the sign of the angle's cosine gives the arm. nullopt if kappa = 0 or the
  /// tangent is vertical, or if the geometry is not finite.
  std::optional<Localisation> localise(const LocalGeometry& local) const;
};

/// The foot point at a known t; also correct at the cusp.
FootPoint foot_point_at(const SemiCubicalParabola& curve, double t, const Vec2& point);

static_assert(PlaneCurve<SemiCubicalParabola>);

}  // namespace palpate
