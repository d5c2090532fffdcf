#include "core/curves/cubic_spline.h"

#include <algorithm>
#include <cmath>

#include "core/curves/all_feet.h"
#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"
#include "core/curves/place_refinement.h"
#include "core/numerics/polynomials/real_roots.h"

namespace palpate {

double CubicSpline::c_of_bend(double radius_m) { return std::sqrt(2.0 * radius_m); }

bool CubicSpline::is_valid() const {
  return std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && a > 0.0 && c != 0.0;
}

LocalGeometry CubicSpline::geometry(double t) const {
  const double y1 = (3.0 * a * t + 2.0 * b) * t + c;
  const double y2 = 6.0 * a * t + 2.0 * b;
  const double speed2 = 4.0 * t * t + y1 * y1;
  const double bend = 6.0 * a * t * t - 2.0 * c;  // x' y'' - x'' y'
  const double kappa = bend / (speed2 * std::sqrt(speed2));
  const double kappa_s =
      (12.0 * a * t * speed2 - 3.0 * bend * (4.0 * t + y1 * y2)) / (speed2 * speed2 * speed2);
  return {std::atan2(y1, 2.0 * t), kappa, kappa_s};
}

namespace {

/// A place of the curve where its x is the point's, on the arm that is nearer to the point there;
/// the vertex for a point behind it.
double place_beside(const CubicSpline& curve, const Vec2& point) {
  const double root = std::sqrt(std::max(point.x(), 0.0));
  const auto off = [&](double t) { return std::abs(curve.position(t).y() - point.y()); };
  return off(root) <= off(-root) ? root : -root;
}

/// (C - p) . C' about a place t of the curve, by u: 0 at the feet t + u. About the vertex, far from
/// which a spline is nearly a cubical parabola, the same roots would be small differences of terms
/// that grow with the fifth power of t: feet were lost by a thousandth of the part.
Polynomial<5> foot_condition(const CubicSpline& curve, double t, const Vec2& point) {
  const double a = curve.a;
  const CurveDerivatives at = curve.derivatives(t);
  const Vec2 away = at.position - point;
  const double x1 = at.first.x();
  const double y1 = at.first.y();
  const double y2 = 0.5 * at.second.y();
  Polynomial<5> condition;
  condition << away.dot(at.first), at.first.squaredNorm() + away.dot(at.second),
      3.0 * (x1 + y1 * y2 + a * away.y()), 2.0 + 2.0 * y2 * y2 + 4.0 * a * y1, 5.0 * a * y2,
      3.0 * a * a;
  return condition;
}

}  // namespace

FootPoint CubicSpline::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  const double beside = place_beside(*this, point);
  return nearest_foot_point(*this, point, [&](const auto& visit) {
    visit_real_roots<5>(foot_condition(*this, beside, point), [&](double u) { visit(beside + u); });
  });
}

FootPlaces all_feet(const CubicSpline& curve, const Vec2& point) {
  FootPlaces places;
  const double beside = place_beside(curve, point);
  visit_real_roots<5>(foot_condition(curve, beside, point), [&](double u) {
    if (is_nearest_beside(curve, beside + u, point)) {
      places.add(beside + u);
    }
  });
  return places;
}

double CubicSpline::speed(double t) const {
  const double x = 2.0 * t;
  const double y = (3.0 * a * t + 2.0 * b) * t + c;
  return std::sqrt(x * x + y * y);
}

double CubicSpline::arc_length(double t0, double t1) const {
  // For small c there is a sharp bend near t = 0.
  const double t = std::max(std::abs(t0), std::abs(t1));
  const double terms = (3.0 * a * t + 2.0 * std::abs(b)) * t + std::abs(c);  // of y'
  return integrate_speed_by_sides([this](double u) { return speed(u); }, t0, t1,
                                  rounding_of_terms(terms));
}

double CubicSpline::parameter_at_arc_length(double t0, double s) const {
  const auto speed_at = [this](double u) { return speed(u); };
  // x = t^2: an arc of length s from t = 0 ends below sqrt(s).
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed_at, t0, s,
                           std::sqrt(std::abs(s)));
}

ParameterDomain CubicSpline::domain() const { return kUnbounded; }

std::optional<Localisation> CubicSpline::localise(const LocalGeometry& local) const {
  if (!is_finite(local)) {
    return std::nullopt;
  }
  // (45) in homogeneous form: sin(phi) 2 t = cos(phi) (3 a t^2 + 2 b t + c). At an inflection the
  // slope is extreme and the discriminant is 0. Rounding or noise can make it negative; it then
  // counts as 0.
  const double cosine = std::cos(local.tangent_angle);
  const double sine = std::sin(local.tangent_angle);
  const double quadratic = 3.0 * a * cosine;
  const double half_linear = b * cosine - sine;
  const double constant = c * cosine;
  const double discriminant = half_linear * half_linear - quadratic * constant;
  const double q =
      -(half_linear + std::copysign(std::sqrt(std::max(discriminant, 0.0)), half_linear));
  RefinedPlace best;
  bool along = true;
  for (const double t : {q / quadratic, q != 0.0 ? constant / q : 0.0}) {
    if (!std::isfinite(t)) {
      continue;
    }
    const bool here_along = std::cos(geometry(t).tangent_angle - local.tangent_angle) > 0.0;
    const RefinedPlace place = refine_place(*this, t, here_along ? local : reversed(local));
    if (place.disagreement < best.disagreement) {
      best = place;
      along = here_along;
    }
  }
  if (!std::isfinite(best.disagreement)) {
    return std::nullopt;
  }
  return finite_place(best.t, along);
}

}  // namespace palpate
