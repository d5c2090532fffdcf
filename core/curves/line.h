// Straight line.
#pragma once

#include "core/curves/plane_curve.h"

namespace palpate {

/// A straight line (t, 0). No shape parameter.
struct Line {
  static constexpr CurveClass curve_class = CurveClass::Line;
  static constexpr int parameter_count = 0;
  using Parameters = Eigen::Matrix<double, 0, 1>;

  static Line from_parameters(const Parameters&) { return {}; }
  Parameters parameters() const { return Parameters(); }

  /// Whether the parameters are finite and in the range of the canonical form.
  bool is_valid() const;

  Vec2 position(double t) const;
  CurveDerivatives derivatives(double t) const;
  LocalGeometry geometry(double t) const;
  /// Derivative of the position by the shape parameters at fixed t; 2 x 0.
  Eigen::Matrix<double, 2, 0> position_by_parameters(double t) const;

  /// Nearest point of the whole curve.
  FootPoint foot_point(const Vec2& point) const;

  /// Arc length from t0 to t1, negative if t1 < t0. [m]
  double arc_length(double t0, double t1) const;
  /// The t at signed arc length s [m] from t0.
  double parameter_at_arc_length(double t0, double s) const;

  ParameterDomain domain() const;

  /// The place and direction of travel with this local geometry, signed by travel (section 5.3).
  /// All places of a line are alike: t = 0, along increasing t. nullopt if the geometry is not
  /// finite.
  std::optional<Localisation> localise(const LocalGeometry& local) const;
};

static_assert(PlaneCurve<Line>);

}  // namespace palpate
