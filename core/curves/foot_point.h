// Foot points, the parts that all classes share: the signed result, the choice of the nearest
// candidate, its last digits, and the search from a nearby start.
#pragma once

#include <cmath>
#include <limits>

#include "core/curves/plane_curve.h"

namespace palpate {

/// The result for a point that is not finite: infinitely far away.
template <typename C>
FootPoint no_foot_point(const C& curve) {
  return {0.0, curve.position(0.0), std::numeric_limits<double>::infinity()};
}

/// The foot point at a known t, with its signed distance.
template <typename C>
FootPoint foot_point_at(const C& curve, double t, const Vec2& point) {
  const CurveDerivatives d = curve.derivatives(t);
  const Vec2 away = point - d.position;
  const double distance = away.norm();
  return {t, d.position, cross(d.first, away) < 0.0 ? -distance : distance};
}

/// Half the second derivative of the squared distance by t.
inline double bend_of_distance(const CurveDerivatives& at, const Vec2& point) {
  return at.first.squaredNorm() + (at.position - point).dot(at.second);
}

/// Whether the curve is nearer to the point at a stationary t than beside it.
template <typename C>
bool is_nearest_beside(const C& curve, double t, const Vec2& point) {
  return bend_of_distance(curve.derivatives(t), point) > 0.0;
}

/// Improves a foot that is known to a few digits to full precision: Newton's method on (C(t) - p) .
/// C'(t) = 0 from t. It stops when the left side no longer shrinks or the distance grows by more
/// than rounding.
template <typename C>
double polish_foot_point(const C& curve, double t, const Vec2& point) {
  constexpr int kMostIterations = 8;  // the digits double: four from the first, four to spare
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  double best = t;
  double best_slope = std::numeric_limits<double>::infinity();
  double best_distance2 = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostIterations; ++i) {
    const CurveDerivatives d = curve.derivatives(t);
    const Vec2 away = d.position - point;
    const double slope = away.dot(d.first);
    const double distance2 = away.squaredNorm();
    if (!(std::abs(slope) < best_slope) || distance2 > best_distance2 * (1.0 + kRounding)) {
      break;
    }
    best = t;
    best_slope = std::abs(slope);
    best_distance2 = distance2;
    const double second = bend_of_distance(d, point);
    const double step = -slope / (second > 0.0 ? second : d.first.squaredNorm());
    if (!std::isfinite(step) || step == 0.0) {
      break;
    }
    t += step;
  }
  return best;
}

/// The nearest of the candidates that `visit_candidates(visit)` passes to `visit`, improved to full
/// precision. One candidate must be close to the global minimum of the distance.
template <typename C, typename VisitCandidates>
FootPoint nearest_foot_point(const C& curve, const Vec2& point,
                             const VisitCandidates& visit_candidates) {
  double best = 0.0;
  double best_distance2 = std::numeric_limits<double>::infinity();
  visit_candidates([&](double candidate) {
    const double distance2 = (curve.position(candidate) - point).squaredNorm();
    if (distance2 < best_distance2) {
      best_distance2 = distance2;
      best = candidate;
    }
  });
  return foot_point_at(curve, polish_foot_point(curve, best, point), point);
}

/// The foot of `point` that Newton's method reaches from `t_start`, for callers that track t from
/// sample to sample. It is a local minimum of the distance and no farther from the point than
/// t_start is. t is not wrapped where a curve closes. Where Newton's method meets no minimum
/// (t_start beyond the evolute, too far away or not finite), returns the nearest point of the whole
/// curve, with the t closest to t_start if the curve is periodic.
template <typename C>
FootPoint foot_point_near(const C& curve, const Vec2& point, double t_start) {
  // Five steps from a start within a tenth of the radius of curvature, plus some halvings.
  constexpr int kMostIterations = 15;
  // Newton's method has converged if the step moves the foot by no more than the rounding of the
  // points, or if the step is small and no longer shrinks: near the evolute rounding is magnified.
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  constexpr double kSmall = 1e-10;
  double t = t_start;
  double step = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double last_move = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostIterations; ++i) {
    const CurveDerivatives d = curve.derivatives(t + step);
    const Vec2 away = d.position - point;
    const double distance = away.norm();
    const double size = d.position.norm() + point.norm();
    if (!(distance <= least + kRounding * size)) {
      step *= 0.5;  // too far: the distance grew
      continue;
    }
    t += step;
    least = distance;
    const double second = d.first.squaredNorm() + away.dot(d.second);
    if (!(second > 0.0)) {
      break;
    }
    step = -away.dot(d.first) / second;
    const double move = std::abs(step) * d.first.norm();
    if (move <= kRounding * size) {
      return foot_point_at(curve, t + step, point);
    }
    if (move <= kSmall * size && move > 0.5 * last_move) {
      return foot_point_at(curve, t, point);
    }
    last_move = move;
  }
  FootPoint foot = curve.foot_point(point);
  const double period = curve.domain().period;
  if (period > 0.0 && std::isfinite(t_start)) {
    foot.t += period * std::round((t_start - foot.t) / period);
  }
  return foot;
}

}  // namespace palpate
