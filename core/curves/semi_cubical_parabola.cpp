#include "core/curves/semi_cubical_parabola.h"

#include <cmath>
#include <limits>

#include "core/curves/arc_length.h"
#include "core/curves/polynomial_foot_point.h"

namespace palpate {

bool SemiCubicalParabola::is_valid() const {
  return std::isfinite(a) && std::isfinite(b) && a > 0.0;
}

Vec2 SemiCubicalParabola::position(double t) const { return {t * t, (a * t + b) * t * t}; }

CurveDerivatives SemiCubicalParabola::derivatives(double t) const {
  return {position(t),
          {2.0 * t, (3.0 * a * t + 2.0 * b) * t},
          {2.0, 6.0 * a * t + 2.0 * b},
          {0.0, 6.0 * a}};
}

LocalGeometry SemiCubicalParabola::geometry(double t) const {
  const double slope = 1.5 * a * t + b;
  const double q = 1.0 + slope * slope;
  // Towards the cusp kappa grows without bound; at it the direction is that of the arm t > 0.
  const double direction = t < 0.0 ? -1.0 : 1.0;
  const double kappa = 0.75 * a / (std::abs(t) * q * std::sqrt(q));
  // d kappa / dt over the speed 2 |t| sqrt(q), brought over one denominator.
  const double kappa_s = -kappa * (q + 4.5 * a * t * slope) / (2.0 * t * std::abs(t) * q * std::sqrt(q));
  return {std::atan2(direction * slope, direction), kappa, kappa_s};
}

Eigen::Matrix<double, 2, 2> SemiCubicalParabola::position_by_parameters(double t) const {
  Eigen::Matrix<double, 2, 2> m;
  m << 0.0, 0.0, t * t * t, t * t;
  return m;
}

FootPoint SemiCubicalParabola::foot_point(const Vec2& point) const {
  // (C - p) . C' / t = 2 (t^2 - x) + (a t^3 + b t^2 - y)(3 a t + 2 b) = 0, and the cusp t = 0.
  Eigen::Matrix<double, 5, 1> condition;
  condition << -2.0 * point.x() - 2.0 * b * point.y(), -3.0 * a * point.y(), 2.0 + 2.0 * b * b,
      5.0 * a * b, 3.0 * a * a;
  FootPoint foot = nearest_foot_point(*this, point, [&](const auto& visit) {
    visit(0.0);
    visit_roots<4>(condition, visit);
  });
  if (foot.t == 0.0) {
    // The tangent at the cusp is (1, b) on the arm t > 0, reversed on the other.
    const double side = point.y() - b * point.x();
    foot.distance = std::copysign(foot.distance, side);
  }
  return foot;
}

double SemiCubicalParabola::arc_length(double t0, double t1) const {
  const auto speed = [this](double t) {
    return std::abs(t) * std::hypot(2.0, 3.0 * a * t + 2.0 * b);
  };
  if (t0 * t1 < 0.0) {  // |t| has a corner at the cusp
    return integrate_speed(speed, t0, 0.0) + integrate_speed(speed, 0.0, t1);
  }
  return integrate_speed(speed, t0, t1);
}

double SemiCubicalParabola::parameter_at_arc_length(double t0, double s) const {
  const auto speed = [this](double t) {
    return std::abs(t) * std::hypot(2.0, 3.0 * a * t + 2.0 * b);
  };
  // From the cusp the arc grows as t^2.
  const double slope_speed = std::hypot(2.0, 2.0 * b);
  const double first = std::min(std::sqrt(std::abs(s) / slope_speed),
                                t0 != 0.0 ? std::abs(s) / speed(t0)
                                          : std::numeric_limits<double>::infinity());
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed, t0, s,
                           first);
}

ParameterDomain SemiCubicalParabola::domain() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {-kInfinity, kInfinity, 0.0};
}

std::optional<Localisation> SemiCubicalParabola::localise(const LocalGeometry& local) const {
  const double cosine = std::cos(local.tangent_angle);
  if (cosine == 0.0) {
    return std::nullopt;
  }
  const double t = 2.0 * (std::tan(local.tangent_angle) - b) / (3.0 * a);
  if (t == 0.0) {
    return std::nullopt;
  }
  return Localisation{t, (t > 0.0) == (cosine > 0.0)};  // x grows with |t|
}

}  // namespace palpate
