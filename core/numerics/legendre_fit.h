// Weighted least squares of a polynomial on [-1, 1] in Legendre's basis. For samples spread over
// the interval the normal equations are nearly diagonal, so that nothing is lost by forming them;
// their Cholesky factor orthonormalises the basis for the samples at hand, and each lower degree's
// fit is a leading block of it.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <utility>

#include "core/numerics/legendre_sums.h"
#include "core/numerics/small_cholesky.h"

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
  // Term by term, with quotients that the compiler knows: a division each was most of the time.
  [&]<int... K>(std::integer_sequence<int, K...>) {
    ((p[K + 2] = (2.0 * K + 3.0) / (K + 2.0) * u * p[K + 1] - (K + 1.0) / (K + 2.0) * p[K]), ...);
  }
  (std::make_integer_sequence<int, (Size > 2 ? Size - 2 : 0)>());
  return p;
}

/// Derivatives 0 ... Orders-1 (rows) of P_0 ... P_{Size-1} (columns) at u, from the derivative of
/// the recurrence.
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

  /// Of points that are summed already.
  template <int Terms>
  explicit LegendreFit(const LegendreSums<Terms, kSize>& sums)
      : gram_(sums.template products<kSize, kSize>()),
        moment_(sums.moments()),
        weight_(sums.weight()) {}

  void add(double u, double v, double weight) { add(legendre<kSize>(u), v, weight); }

  /// The same, of P_0(u) ... P_Degree(u).
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

  /// False where the samples do not determine the polynomial. An error of standard deviation
  /// `sigma` in the abscissae (units of u) passes for spread of its own: it adds
  /// sigma^2 k (k + 1) / 2 to the mean square of P_k, and shrinks the coefficient of P_k by that
  /// relative to what the lower degrees leave of P_k. Refused where any is above kMaxShrinkage.
  bool factorise(double sigma) {
    if (!cholesky(gram_, &factor_)) {
      return false;
    }
    for (int k = 1; k < kSize; ++k) {
      const double left = factor_(k, k) * factor_(k, k) / weight_;
      const double blur = sigma * sigma * 0.5 * k * (k + 1);
      // Negated so that NaN is refused too.
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

  /// J with J^T J = rows * (covariance of the coefficients / sigma^2) * rows^T, for functions of
  /// the coefficients of the fit of degree Lower whose gradients are `rows`.
  template <int Lower = Degree, int Rows>
  Eigen::Matrix<double, Lower + 1, Rows> whitened(
      const Eigen::Matrix<double, Rows, Lower + 1>& rows) const {
    Eigen::Matrix<double, Lower + 1, Rows> columns;
    for (int i = 0; i < Rows; ++i) {
      columns.col(i) = solve_lower<Lower + 1, kSize>(factor_, rows.row(i).transpose());
    }
    return columns;
  }

  /// (normal matrix)^-1 gradient: its product with (P_0(u_i) ... P_Degree(u_i)) w_i is what a unit
  /// error of v_i does to the function of the coefficients that has this gradient.
  Vector influence(const Vector& gradient) const { return solve_cholesky(factor_, gradient); }

  /// The normal matrix, of which the lower triangle is held, and the right hand side.
  const Matrix& normal() const { return gram_; }
  const Vector& moments() const { return moment_; }

  /// The normal matrix's Cholesky factor, lower triangular.
  const Matrix& factor() const { return factor_; }

  /// Coefficients in the orthonormal basis: independent, each with the samples' variance (for
  /// weights relative to it). Score k is what degree k adds.
  const Vector& scores() const { return scores_; }

 private:
  /// Mean square of what the lower degrees leave of P_k, relative to the basis' maximum 1: below,
  /// rounding decides.
  static constexpr double kMinPivot = 1e4 * std::numeric_limits<double>::epsilon();
  /// Of the same by noise along the axis: more of it takes a tenth and more of what P_k tells.
  static constexpr double kMaxShrinkage = 0.1;

  Matrix gram_ = Matrix::Zero();
  Matrix factor_ = Matrix::Zero();
  Vector moment_ = Vector::Zero();
  Vector scores_ = Vector::Zero();
  double weight_ = 0.0;
};

}  // namespace palpate
