// Appendix A: the resultant of two polynomials by their Sylvester matrix, and with it the equation
// of a polynomial curve.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/curves/algebraic/bivariate_polynomial.h"
#include "core/curves/algebraic/polynomial_curve.h"

namespace palpate {

/// (52): rows t^(n-1) p ... p, t^(m-1) q ... q over falling powers of t. Coefficients from the
/// constant upwards, the last ones not 0; degrees m, n >= 0.
Eigen::MatrixXd sylvester_matrix(std::span<const double> p, std::span<const double> q);

struct Resultant {
  double sign = 0.0;  ///< of the determinant; 0 where the matrix is singular to rounding
  /// log of the modulus of the determinant as computed, -infinity for 0: the value itself may leave
  /// the range of a double.
  double log_modulus = 0.0;
  int common_roots = 0;  ///< rank deficiency to rounding: the degree of the greatest common divisor

  double value() const;  ///< 0 where there are common roots; may overflow
};

/// Res(p, q) by a rank-revealing factorisation of the scaled matrix: each polynomial to unit size,
/// and t such that the ends of both weigh alike. Leading zeros are dropped. A pivot counts as zero
/// below (m + n) epsilon of the largest, the bound of the factorisation's backward error. O((m +
/// n)^3). Precondition: neither polynomial is all zero.
Resultant resultant(std::span<const double> p, std::span<const double> q);

/// The equation f(x, y) = 0 of a polynomial curve: Res_t(x(t) - x, y(t) - y) as Bezout's
/// determinant, whose entries are linear in x and y, expanded about the curve's point at t = 0.
/// Every point of the curve satisfies it. Degree: that of the curve in t (0 and f = 0 for a
/// constant).
BivariatePolynomial implicit_equation(const PolynomialCurve2& curve);

}  // namespace palpate
