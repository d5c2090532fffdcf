#include "core/recognition/fit/spline_pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/curves/algebraic/polynomial_curve.h"

namespace palpate {
namespace {

/// On which side of c = 0 a spline lies.
bool has_loop(const PolynomialCoefficients& c) {
  // About the vertex travel across the axis is c.
  const auto vertex = vertex_of(c);
  return vertex && first_derivative(c, *vertex).dot(c.col(3)) < 0.0;
}

}  // namespace

bool is_same_valley(const PolynomialFit& a, const PolynomialFit& b) {
  return std::abs(a.chi2 - b.chi2) <= kSameChi2 * std::max(1.0, a.chi2) &&
         std::abs(cross(Vec2(a.coefficients.col(3).normalized()),
                        Vec2(b.coefficients.col(3).normalized()))) <= kSameAngle &&
         has_loop(a.coefficients) == has_loop(b.coefficients);
}

void take(PolynomialFit fit, SplinePair* pair) {
  if (!std::isfinite(fit.chi2)) {
    return;
  }
  if (!pair->best || fit.chi2 < pair->best->chi2) {
    if (!pair->best || !is_same_valley(fit, *pair->best)) {
      std::swap(pair->best, pair->rival);
    }
    pair->best = std::move(fit);
  } else if (is_same_valley(fit, *pair->best)) {
    return;
  } else if (!pair->rival || fit.chi2 < pair->rival->chi2) {
    pair->rival = std::move(fit);
  }
}

std::optional<PolynomialFit> twin_of(const PolynomialFit& fit) {
  const auto vertex = vertex_of(fit.coefficients);
  if (!vertex) {
    return std::nullopt;
  }
  PolynomialFit twin = fit;
  PolynomialCoefficients& c = twin.coefficients;
  c = PolynomialCurve2{fit.coefficients}.shifted(*vertex).coefficients;
  const Vec2 across = c.col(3);
  const double moved = 4.0 / 3.0 * c.col(1).dot(across) / across.squaredNorm();
  c.col(0) -= moved * c.col(2);
  c.col(1) = -c.col(1);
  for (double& t : twin.t) {
    const double from_vertex = t - *vertex;
    t = std::copysign(std::sqrt(std::max(from_vertex * from_vertex + moved, 0.0)), from_vertex);
  }
  normalise_parameter(PolynomialModel::CubicSpline, &twin);
  return c.allFinite() ? std::optional(std::move(twin)) : std::nullopt;
}

}  // namespace palpate
