// Nearest points of curves whose condition of perpendicularity is a polynomial.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/Polynomials>

#include "core/curves/plane_curve.h"

namespace palpate {

/// Calls `visit(root)` with the real part of every root of sum c_k x^k; parts of complex roots too, so
/// that a double root blurred by rounding is not lost. Leading zeros are dropped; x is scaled so that
/// the first and last coefficients balance. No allocation.
template <int kDegree, typename Visit>
void visit_roots(const Eigen::Matrix<double, kDegree + 1, 1>& c, const Visit& visit) {
  const double largest = c.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) {
    return;
  }
  if (std::abs(c[kDegree]) <= std::numeric_limits<double>::min() * largest) {
    if constexpr (kDegree > 1) {
      visit_roots<kDegree - 1>(c.template head<kDegree>(), visit);
    }
    return;
  }
  if constexpr (kDegree == 1) {
    visit(-c[0] / c[1]);
  } else {
    // Largest k-th root of |c_{n-k} / c_n|: a bound on the roots within a factor of two.
    double scale = 0.0;
    for (int k = 1; k <= kDegree; ++k) {
      scale = std::max(scale, std::pow(std::abs(c[kDegree - k] / c[kDegree]), 1.0 / k));
    }
    if (!(scale > 0.0) || !std::isfinite(scale)) {
      visit(0.0);
      return;
    }
    Eigen::Matrix<double, kDegree + 1, 1> balanced;
    double power = 1.0;
    for (int k = kDegree; k >= 0; --k) {
      balanced[k] = c[k] / c[kDegree] / power;
      power *= scale;
    }
    const Eigen::PolynomialSolver<double, kDegree> solver(balanced);
    for (int k = 0; k < kDegree; ++k) {
      visit(scale * solver.roots()[k].real());
    }
  }
}

/// Signed foot point of `point` at parameter t.
template <typename C>
FootPoint foot_point_at(const C& curve, double t, const Vec2& point) {
  const CurveDerivatives d = curve.derivatives(t);
  const Vec2 away = point - d.position;
  const double side = cross(d.first, away);
  return {t, d.position, side < 0.0 ? -away.norm() : away.norm()};
}

/// Newton's method on (curve(t) - point) . curve'(t) = 0 from t, while it brings that nearer to 0 and
/// the point no farther away than rounding.
template <typename C>
double polish_foot_point(const C& curve, double t, const Vec2& point) {
  constexpr int kMostIterations = 8;
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
    const double curvature = d.first.squaredNorm() + away.dot(d.second);
    const double step = -slope / (curvature > 0.0 ? curvature : d.first.squaredNorm());
    if (!std::isfinite(step) || step == 0.0) {
      break;
    }
    t += step;
  }
  return best;
}

/// The nearest of the polished candidates that `visit_candidates(visit)` hands over.
template <typename C, typename VisitCandidates>
FootPoint nearest_foot_point(const C& curve, const Vec2& point,
                             const VisitCandidates& visit_candidates) {
  double best = 0.0;
  double best_distance2 = std::numeric_limits<double>::infinity();
  visit_candidates([&](double candidate) {
    const double t = polish_foot_point(curve, candidate, point);
    const double distance2 = (curve.position(t) - point).squaredNorm();
    if (distance2 < best_distance2) {
      best_distance2 = distance2;
      best = t;
    }
  });
  return foot_point_at(curve, best, point);
}

}  // namespace palpate
