#include "core/curves/cubical_parabola.h"

#include <cmath>

#include "core/curves/all_feet.h"
#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"
#include "core/curves/place_refinement.h"
#include "core/numerics/polynomials/real_roots.h"

namespace palpate {

bool CubicalParabola::is_valid() const { return std::isfinite(a) && std::isfinite(c) && a != 0.0; }

LocalGeometry CubicalParabola::geometry(double t) const {
  const double slope = 3.0 * a * t * t + c;
  const double q = 1.0 + slope * slope;
  return {std::atan(slope), 6.0 * a * t / (q * std::sqrt(q)),
          6.0 * a * (1.0 - 18.0 * a * t * t * (slope / q)) / (q * q)};
}

namespace {

/// (C - p) . C' = (t - x) + (a t^3 + c t - y)(3 a t^2 + c), which is 0 at feet.
Polynomial<5> foot_condition(const CubicalParabola& curve, const Vec2& point) {
  const auto [a, c] = curve;
  Polynomial<5> condition;
  condition << -point.x() - c * point.y(), 1.0 + c * c, -3.0 * a * point.y(), 4.0 * a * c, 0.0,
      3.0 * a * a;
  return condition;
}

}  // namespace

FootPoint CubicalParabola::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  return nearest_foot_point(*this, point, [&](const auto& visit) {
    visit_real_roots<5>(foot_condition(*this, point), visit);
  });
}

FootPlaces all_feet(const CubicalParabola& curve, const Vec2& point) {
  FootPlaces places;
  visit_real_roots<5>(foot_condition(curve, point), [&](double t) {
    if (is_nearest_beside(curve, t, point)) {
      places.add(t);
    }
  });
  return places;
}

double CubicalParabola::speed(double t) const {
  const double slope = 3.0 * a * t * t + c;
  return std::sqrt(1.0 + slope * slope);
}

double CubicalParabola::arc_length(double t0, double t1) const {
  const double t = std::max(std::abs(t0), std::abs(t1));
  const double terms = 3.0 * std::abs(a) * t * t + std::abs(c);  // of y'
  return integrate_speed([this](double u) { return speed(u); }, t0, t1, rounding_of_terms(terms));
}

double CubicalParabola::parameter_at_arc_length(double t0, double s) const {
  const auto speed_at = [this](double u) { return speed(u); };
  // x = t, so no arc is shorter than its step in t.
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed_at, t0, s,
                           std::abs(s));
}

ParameterDomain CubicalParabola::domain() const { return kUnbounded; }

std::optional<Localisation> CubicalParabola::localise(const LocalGeometry& local) const {
  const double cosine = std::cos(local.tangent_angle);
  if (!is_finite(local) || cosine == 0.0) {
    return std::nullopt;
  }
  const bool along = cosine > 0.0;  // x grows with t
  const LocalGeometry forward = along ? local : reversed(local);
  const double slope = std::tan(forward.tangent_angle);
  const double q = 1.0 + slope * slope;
  const double t = forward.kappa * q * std::sqrt(q) / (6.0 * a);
  const RefinedPlace refined = refine_place(*this, t, forward);
  return finite_place(std::isfinite(refined.disagreement) ? refined.t : t, along);
}

}  // namespace palpate
