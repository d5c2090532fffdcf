#include "core/curves/algebraic/resultant.h"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace palpate {
namespace {

std::span<const double> without_leading_zeros(std::span<const double> p) {
  while (!p.empty() && p.back() == 0.0) {
    p = p.first(p.size() - 1);
  }
  assert(!p.empty());
  return p;
}

/// p(2^exponent t) / 2^size: exact. `size` receives the exponent taken out.
std::vector<double> scaled(std::span<const double> p, int exponent, int* size) {
  std::vector<double> result(p.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    result[k] = std::ldexp(p[k], static_cast<int>(k) * exponent);
    largest = std::max(largest, std::abs(result[k]));
  }
  *size = std::ilogb(largest);
  for (double& c : result) {
    c = std::ldexp(c, -*size);
  }
  return result;
}

/// Power of two for t that makes the constant and the leading terms of p alike.
double balance(std::span<const double> p) {
  if (p.size() < 2 || p.front() == 0.0) {
    return 0.0;
  }
  return (std::log2(std::abs(p.front())) - std::log2(std::abs(p.back()))) /
         static_cast<double>(p.size() - 1);
}

/// Of linear polynomials without constant: entry of Bezout's matrix.
BivariatePolynomial linear(double x, double y, double constant, double scale, const Vec2& origin) {
  BivariatePolynomial f(1, origin, scale);
  f.coefficient(0, 0) = constant;
  f.coefficient(1, 0) = x * scale;
  f.coefficient(0, 1) = y * scale;
  return f;
}

}  // namespace

Eigen::MatrixXd sylvester_matrix(std::span<const double> p, std::span<const double> q) {
  const auto m = static_cast<Eigen::Index>(p.size()) - 1;
  const auto n = static_cast<Eigen::Index>(q.size()) - 1;
  assert(m >= 0 && n >= 0);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(m + n, m + n);
  for (Eigen::Index row = 0; row < n; ++row) {
    for (Eigen::Index k = 0; k <= m; ++k) {
      matrix(row, row + k) = p[static_cast<std::size_t>(m - k)];
    }
  }
  for (Eigen::Index row = 0; row < m; ++row) {
    for (Eigen::Index k = 0; k <= n; ++k) {
      matrix(n + row, row + k) = q[static_cast<std::size_t>(n - k)];
    }
  }
  return matrix;
}

double Resultant::value() const {
  return common_roots > 0 || sign == 0.0 ? 0.0 : sign * std::exp(log_modulus);
}

Resultant resultant(std::span<const double> p_all, std::span<const double> q_all) {
  const std::span<const double> p = without_leading_zeros(p_all);
  const std::span<const double> q = without_leading_zeros(q_all);
  const int m = static_cast<int>(p.size()) - 1;
  const int n = static_cast<int>(q.size()) - 1;
  Resultant result;
  if (m + n == 0) {
    result.sign = 1.0;  // of an empty matrix
    return result;
  }
  const int exponent =
      static_cast<int>(std::lround(m + n > 0 ? (m * balance(p) + n * balance(q)) / (m + n) : 0.0));
  int size_p = 0;
  int size_q = 0;
  const std::vector<double> unit_p = scaled(p, exponent, &size_p);
  const std::vector<double> unit_q = scaled(q, exponent, &size_q);
  const Eigen::MatrixXd matrix = sylvester_matrix(unit_p, unit_q);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  const double zero = (m + n) * std::numeric_limits<double>::epsilon() * qr.maxPivot();
  double log_modulus = 0.0;
  // Each Householder reflection and each swap of columns changes the sign.
  double sign = qr.colsPermutation().determinant() >= 0 ? 1.0 : -1.0;
  for (Eigen::Index k = 0; k < m + n; ++k) {
    const double pivot = qr.matrixR()(k, k);
    result.common_roots += std::abs(pivot) <= zero ? 1 : 0;
    sign *= pivot < 0.0 ? -1.0 : 1.0;
    sign *= qr.hCoeffs()[k] != 0.0 ? -1.0 : 1.0;
    log_modulus += std::log(std::abs(pivot));
  }
  // Res(alpha p, beta q) = alpha^n beta^m Res(p, q); t -> rho t multiplies it by rho^(m n).
  constexpr double kLog2 = 0.693147180559945309417;
  result.log_modulus =
      log_modulus + kLog2 * (static_cast<double>(size_p) * n + static_cast<double>(size_q) * m -
                             static_cast<double>(exponent) * m * n);
  result.sign = result.common_roots > 0 ? 0.0 : sign;
  return result;
}

BivariatePolynomial implicit_equation(const PolynomialCurve2& curve) {
  const auto& c = curve.coefficients;
  const Vec2 origin = c.col(0);
  int degree = 3;
  while (degree > 0 && c.col(degree).isZero(0.0)) {
    --degree;
  }
  // The curve's own size, so that both polynomials have coefficients of about one.
  const double size = c.rightCols<3>().cwiseAbs().maxCoeff();
  if (degree == 0 || !(size > 0.0)) {
    return BivariatePolynomial(0, origin);
  }
  // [i, j] = p_i q_j - p_j q_i with p = x(t) - x and q = y(t) - y, in units of `size`.
  const auto bracket = [&](int i, int j) {
    if (i == 0) {
      // p_0 = -(x - x0), q_0 = -(y - y0)
      return linear(-c(1, j) / (size * size), c(0, j) / (size * size), 0.0, size, origin);
    }
    return linear(0.0, 0.0, (c(0, i) * c(1, j) - c(0, j) * c(1, i)) / (size * size), size, origin);
  };
  if (degree == 1) {
    return bracket(0, 1);
  }
  const BivariatePolynomial b01 = bracket(0, 1);
  const BivariatePolynomial b02 = bracket(0, 2);
  const BivariatePolynomial b12 = bracket(1, 2);
  if (degree == 2) {
    return b01 * b12 + b02 * b02 * -1.0;
  }
  const BivariatePolynomial b03 = bracket(0, 3);
  const BivariatePolynomial b13 = bracket(1, 3);
  const BivariatePolynomial b23 = bracket(2, 3);
  // Determinant of [[b01, b02, b03], [b02, b03 + b12, b13], [b03, b13, b23]].
  const BivariatePolynomial middle = b03 + b12;
  const BivariatePolynomial first = middle * b23 + b13 * b13 * -1.0;
  const BivariatePolynomial second = b02 * b23 + b03 * b13 * -1.0;
  const BivariatePolynomial third = b02 * b13 + b03 * middle * -1.0;
  return b01 * first + b02 * second * -1.0 + b03 * third;
}

}  // namespace palpate
