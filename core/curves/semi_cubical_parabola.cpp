#include "core/curves/semi_cubical_parabola.h"

#include <cmath>
#include <limits>

#include "core/curves/all_feet.h"
#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"
#include "core/curves/place_refinement.h"
#include "core/numerics/polynomials/real_roots.h"

namespace palpate {

bool SemiCubicalParabola::is_valid() const {
  return std::isfinite(a) && std::isfinite(b) && a > 0.0;
}

LocalGeometry SemiCubicalParabola::geometry(double t) const {
  const double slope = 1.5 * a * t + b;
  const double q = 1.0 + slope * slope;
  // kappa grows without bound towards the cusp. At the cusp the direction is that of the arm t > 0.
  const double direction = t < 0.0 ? -1.0 : 1.0;
  const double kappa = 0.75 * a / (std::abs(t) * q * std::sqrt(q));
  // d kappa / dt, divided by the speed 2 |t| sqrt(q), over one denominator.
  const double kappa_s =
      -kappa * (q + 4.5 * a * t * slope) / (2.0 * t * std::abs(t) * q * std::sqrt(q));
  return {std::atan2(direction * slope, direction), kappa, kappa_s};
}

namespace {

/// (C - p) . C' / t = 2 (t^2 - x) + (a t^3 + b t^2 - y)(3 a t + 2 b), which is 0 at feet besides
/// the cusp.
Polynomial<4> foot_condition(const SemiCubicalParabola& curve, const Vec2& point) {
  const auto [a, b] = curve;
  Polynomial<4> condition;
  condition << -2.0 * point.x() - 2.0 * b * point.y(), -3.0 * a * point.y(), 2.0 + 2.0 * b * b,
      5.0 * a * b, 3.0 * a * a;
  return condition;
}

}  // namespace

FootPoint SemiCubicalParabola::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  return nearest_foot_point(*this, point, [&](const auto& visit) {
    visit(0.0);
    visit_real_roots<4>(foot_condition(*this, point), visit);
  });
}

FootPlaces all_feet(const SemiCubicalParabola& curve, const Vec2& point) {
  FootPlaces places;
  places.add(0.0);
  visit_real_roots<4>(foot_condition(curve, point), [&](double t) {
    if (is_nearest_beside(curve, t, point)) {
      places.add(t);
    }
  });
  return places;
}

FootPoint foot_point_at(const SemiCubicalParabola& curve, double t, const Vec2& point) {
  const CurveDerivatives d = curve.derivatives(t);
  if (d.position.norm() > std::numeric_limits<double>::epsilon() * point.norm()) {
    const Vec2 away = point - d.position;
    const double distance = away.norm();
    return {t, d.position, cross(d.first, away) < 0.0 ? -distance : distance};
  }
  // The cusp has no normal. Both arms turn left, so the points between the arms are on the right.
  // The rest of the plane is on the left, including all points whose nearest point is the cusp.
  const double x = point.x();
  const bool between = x > 0.0 && std::abs(point.y() - curve.b * x) < curve.a * x * std::sqrt(x);
  return {0.0, Vec2::Zero(), between ? -point.norm() : point.norm()};
}

double SemiCubicalParabola::speed(double t) const {
  const double slope = 1.5 * a * t + b;
  return 2.0 * std::abs(t) * std::sqrt(1.0 + slope * slope);
}

double SemiCubicalParabola::arc_length(double t0, double t1) const {
  // |t| has a corner at the cusp.
  const double t = std::max(std::abs(t0), std::abs(t1));
  const double terms = (3.0 * a * t + 2.0 * std::abs(b)) * t;  // of y'
  return integrate_speed_by_sides([this](double u) { return speed(u); }, t0, t1,
                                  rounding_of_terms(terms));
}

double SemiCubicalParabola::parameter_at_arc_length(double t0, double s) const {
  const auto speed_at = [this](double u) { return speed(u); };
  // x = t^2, so no arc from the cusp is shorter than t^2.
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed_at, t0, s,
                           std::sqrt(std::abs(s)));
}

ParameterDomain SemiCubicalParabola::domain() const { return kUnbounded; }

std::optional<Localisation> SemiCubicalParabola::localise(const LocalGeometry& local) const {
  const double cosine = std::cos(local.tangent_angle);
  if (!is_finite(local) || local.kappa == 0.0 || cosine == 0.0) {
    return std::nullopt;
  }
  const bool along = local.kappa > 0.0;  // both arms turn left
  const LocalGeometry forward = along ? local : reversed(local);
  const double arm = along == (cosine > 0.0) ? 1.0 : -1.0;  // x grows with |t|
  const double slope = std::tan(forward.tangent_angle);
  const double q = 1.0 + slope * slope;
  const double t_kappa = arm * 0.75 * a / (forward.kappa * q * std::sqrt(q));
  const double t_slope = 2.0 * (slope - b) / (3.0 * a);
  RefinedPlace best = refine_place(*this, t_kappa, forward);
  if (t_slope * arm > 0.0) {  // a better start far from the cusp
    const RefinedPlace other = refine_place(*this, t_slope, forward);
    best = other.disagreement < best.disagreement ? other : best;
  }
  if (!std::isfinite(best.disagreement) || best.t == 0.0) {
    return std::nullopt;
  }
  return finite_place(best.t, along);
}

}  // namespace palpate
