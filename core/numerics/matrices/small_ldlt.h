// Decomposition L D L^T of small symmetric matrices of fixed size, with pivots from the diagonal.
// It also handles matrices that rounding has left without positive pivots. Written as loops, for
// the reasons given in small_cholesky.h.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

template <int N>
class SmallLdlt {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  explicit SmallLdlt(const Matrix& symmetric) : l_(symmetric) {
    for (int i = 0; i < N; ++i) {
      order_[static_cast<std::size_t>(i)] = i;
    }
    for (int k = 0; k < N; ++k) {
      int pivot = k;
      for (int i = k + 1; i < N; ++i) {
        if (std::abs(l_(i, i)) > std::abs(l_(pivot, pivot))) {
          pivot = i;
        }
      }
      if (pivot != k) {
        swap(k, pivot);
      }
      if (!(std::abs(l_(k, k)) > kLeastPivot)) {
        for (int i = k + 1; i < N; ++i) {
          l_(i, k) = 0.0;
        }
        continue;
      }
      for (int i = k + 1; i < N; ++i) {
        const double factor = l_(i, k) / l_(k, k);
        for (int j = k + 1; j <= i; ++j) {
          l_(i, j) -= factor * l_(j, k);
        }
      }
      for (int i = k + 1; i < N; ++i) {
        l_(i, k) /= l_(k, k);
      }
    }
  }

  /// D, its largest element first.
  Vector pivots() const { return l_.diagonal(); }

  /// The x with matrix * x = b. Components that a zero pivot leaves free are 0.
  Vector solve(const Vector& b) const {
    Vector x;
    for (int i = 0; i < N; ++i) {
      x[i] = b[at(i)];
      for (int k = 0; k < i; ++k) {
        x[i] -= l_(i, k) * x[k];
      }
    }
    for (int i = 0; i < N; ++i) {
      x[i] = std::abs(l_(i, i)) > kLeastPivot ? x[i] / l_(i, i) : 0.0;
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int k = i + 1; k < N; ++k) {
        x[i] -= l_(k, i) * x[k];
      }
    }
    Vector ordered;
    for (int i = 0; i < N; ++i) {
      ordered[at(i)] = x[i];
    }
    return ordered;
  }

  Matrix inverse() const {
    Matrix result;
    for (int i = 0; i < N; ++i) {
      result.col(i) = solve(Vector::Unit(i));
    }
    return result;
  }

 private:
  static constexpr double kLeastPivot = std::numeric_limits<double>::min();

  int at(int i) const { return order_[static_cast<std::size_t>(i)]; }

  /// Swaps rows and columns of the remaining matrix, of which only the lower triangle is stored.
  void swap(int k, int p) {
    std::swap(order_[static_cast<std::size_t>(k)], order_[static_cast<std::size_t>(p)]);
    for (int j = 0; j < k; ++j) {
      std::swap(l_(k, j), l_(p, j));
    }
    for (int i = k + 1; i < p; ++i) {
      std::swap(l_(i, k), l_(p, i));
    }
    for (int i = p + 1; i < N; ++i) {
      std::swap(l_(i, k), l_(i, p));
    }
    std::swap(l_(k, k), l_(p, p));
  }

  Matrix l_;  ///< L below the diagonal, D on the diagonal
  std::array<int, N> order_;
};

}  // namespace palpate
