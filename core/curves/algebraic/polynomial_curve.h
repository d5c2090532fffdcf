// A plane curve with cubic polynomials as its coordinates, (53).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "core/curves/plane_curve.h"

namespace palpate {

/// Column k holds the coefficients of t^k.
using PolynomialCoefficients = Eigen::Matrix<double, 2, 4>;

// Always inlined: the foot points of all fits take a large share of a recognition's time.
[[gnu::always_inline]] inline Vec2 position_at(const PolynomialCoefficients& c, double t) {
  return c.col(0) + t * (c.col(1) + t * (c.col(2) + t * c.col(3)));
}

[[gnu::always_inline]] inline Vec2 first_derivative(const PolynomialCoefficients& c, double t) {
  return c.col(1) + t * (2.0 * c.col(2) + 3.0 * t * c.col(3));
}

[[gnu::always_inline]] inline Vec2 second_derivative(const PolynomialCoefficients& c, double t) {
  return 2.0 * c.col(2) + 6.0 * t * c.col(3);
}

/// The parameter of the bend, where the curve stands still along its axis; nullopt where it never
/// does. The canonical axis is perpendicular to the coefficient of t^3; a parabola's is that of
/// t^2.
inline std::optional<double> vertex_of(const PolynomialCoefficients& c) {
  const Vec2 third = c.col(3);
  const Vec2 axis = third.isZero(0.0) ? Vec2(c.col(2)) : left_of(third);
  const double vertex = -axis.dot(c.col(1)) / (2.0 * axis.dot(c.col(2)));
  return std::isfinite(vertex) ? std::optional(vertex) : std::nullopt;
}

/// x(t) = sum c(0, k) t^k, y(t) = sum c(1, k) t^k, k = 0 ... 3. [m]
struct PolynomialCurve2 {
  using Coefficients = PolynomialCoefficients;
  Coefficients coefficients = Coefficients::Zero();

  Vec2 position(double t) const { return position_at(coefficients, t); }

  CurveDerivatives derivatives(double t) const {
    const Coefficients& c = coefficients;
    return {position_at(c, t), first_derivative(c, t), second_derivative(c, t), 6.0 * c.col(3)};
  }

  /// The same curve over u = t - t0.
  PolynomialCurve2 shifted(double t0) const {
    const Coefficients& c = coefficients;
    PolynomialCurve2 result;
    result.coefficients << position_at(c, t0), first_derivative(c, t0),
        c.col(2) + 3.0 * t0 * c.col(3), c.col(3);
    return result;
  }
};

}  // namespace palpate
