// Weighted least squares of a polynomial on [-1, 1] in Legendre's basis. For samples spread over
// the interval the normal equations are nearly diagonal, so forming them loses no precision. Their
// Cholesky factor orthonormalises the basis for the given samples; the fit of each lower degree is
// a leading block of it.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <utility>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/polynomials/legendre_sums.h"

namespace palpate {

template <int Size>
using LegendreVector = Eigen::Matrix<double, Size, 1>;

/// P_0(u) ... P_{Size-1}(u), by P_{k+1} = ((2k + 1) u P_k - k P_{k-1}) / (k + 1).
template <int Size>
LegendreVector<Size> legendre(double u) {
  LegendreVector<Size> p;
  p[0] = 1.0;
  if constexpr (Size > 1) {
    p[1] = u;
  }
  // Unrolled, with quotients that are known at compile time: a division per term took most of the
  // time.
  [&]<int... K>(std::integer_sequence<int, K...>) {
    ((p[K + 2] = (2.0 * K + 3.0) / (K + 2.0) * u * p[K + 1] - (K + 1.0) / (K + 2.0) * p[K]), ...);
  }
  (std::make_integer_sequence<int, (Size > 2 ? Size - 2 : 0)>());
  return p;
}

/// Derivatives 0 ... Orders-1 (rows) of P_0 ... P_{Size-1} (columns) at u, by the derivative of the
/// recurrence.
template <int Orders, int Size>
Eigen::Matrix<double, Orders, Size> legendre_derivatives(double u) {
  Eigen::Matrix<double, Orders, Size> d = Eigen::Matrix<double, Orders, Size>::Zero();
  d(0, 0) = 1.0;
  for (int k = 0; k + 1 < Size; ++k) {
    for (int m = 0; m < Orders; ++m) {
      double value = u * d(m, k) + (m > 0 ? m * d(m - 1, k) : 0.0);
      value *= 2 * k + 1;
      if (k > 0) {
        value -= k * d(m, k - 1);
      }
      d(m, k + 1) = value / (k + 1);
    }
  }
  return d;
}

/// Normal equations of sum_i w_i (v_i - sum_k c_k P_k(u_i))^2, and their solution.
template <int Degree>
class LegendreFit {
 public:
  static constexpr int kSize = Degree + 1;
  using Vector = LegendreVector<kSize>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  LegendreFit() = default;

  /// From points that are already summed.
  template <int Terms>
  explicit LegendreFit(const LegendreSums<Terms, kSize>& sums)
      : gram_(sums.template products<kSize, kSize>()),
        moment_(sums.moments()),
        weight_(sums.weight()) {}

  void add(double u, double v, double weight) { add(legendre<kSize>(u), v, weight); }

  /// Adds a point, given p = P_0(u) ... P_Degree(u).
  void add(const Vector& p, double v, double weight) {
    for (int i = 0; i < kSize; ++i) {
      const double wp = weight * p[i];
      for (int j = 0; j <= i; ++j) {
        gram_(i, j) += wp * p[j];
      }
      moment_[i] += wp * v;
    }
    weight_ += weight;
  }

  /// Factorises the normal equations; call it before the functions below. False if the samples do
  /// not determine the polynomial. `sigma` is the standard deviation of errors of the abscissae (in
  /// units of u). Such errors look like spread of the samples: they add sigma^2 k (k + 1) / 2 to
  /// the mean square of P_k, and shrink the coefficient of P_k by the ratio of that to the part of
  /// P_k that the lower degrees leave. False if this ratio exceeds kMaxShrinkage for any k.
  bool factorise(double sigma) {
    if (!cholesky(gram_, &factor_)) {
      return false;
    }
    for (int k = 1; k < kSize; ++k) {
      const double left = factor_(k, k) * factor_(k, k) / weight_;
      const double blur = sigma * sigma * 0.5 * k * (k + 1);
      // Negated so that NaN is rejected too.
      if (!(left > kMinPivot && blur <= kMaxShrinkage * left)) {
        return false;
      }
    }
    scores_ = solve_lower<kSize>(factor_, moment_);
    return true;
  }

  /// Coefficients c_0 ... c_Lower of the fit of degree Lower <= Degree.
  template <int Lower = Degree>
  LegendreVector<Lower + 1> coefficients() const {
    return solve_lower_transposed<Lower + 1, kSize>(factor_, scores_.template head<Lower + 1>());
  }

  /// J with J^T J = rows * (covariance of the coefficients / sigma^2) * rows^T. `rows` are the
  /// gradients of functions of the coefficients of the fit of degree Lower.
  template <int Lower = Degree, int Rows>
  Eigen::Matrix<double, Lower + 1, Rows> whitened(
      const Eigen::Matrix<double, Rows, Lower + 1>& rows) const {
    Eigen::Matrix<double, Lower + 1, Rows> columns;
    for (int i = 0; i < Rows; ++i) {
      columns.col(i) = solve_lower<Lower + 1, kSize>(factor_, rows.row(i).transpose());
    }
    return columns;
  }

  /// (normal matrix)^-1 gradient. Its product with (P_0(u_i) ... P_Degree(u_i)) w_i is the effect
  /// of a unit error of v_i on the function of the coefficients that has this gradient.
  Vector influence(const Vector& gradient) const { return solve_cholesky(factor_, gradient); }

  /// The normal matrix (only its lower triangle is set) and the right-hand side.
  const Matrix& normal() const { return gram_; }
  const Vector& moments() const { return moment_; }

  /// The Cholesky factor of the normal matrix, lower triangular.
  const Matrix& factor() const { return factor_; }

  /// Coefficients in the orthonormal basis. They are independent, each with the variance of the
  /// samples (for weights relative to it). Score k is the contribution of degree k.
  const Vector& scores() const { return scores_; }

 private:
  /// Least mean square of the part of P_k that the lower degrees leave, relative to 1, the maximum
  /// of the basis. Below it, rounding determines the result.
  static constexpr double kMinPivot = 1e4 * std::numeric_limits<double>::epsilon();
  /// Largest ratio of noise along the axis to that mean square; see factorise. At a tenth, the
  /// coefficient of P_k shrinks by about a tenth.
  static constexpr double kMaxShrinkage = 0.1;

  Matrix gram_ = Matrix::Zero();
  Matrix factor_ = Matrix::Zero();
  Vector moment_ = Vector::Zero();
  Vector scores_ = Vector::Zero();
  double weight_ = 0.0;
};

}  // namespace palpate
