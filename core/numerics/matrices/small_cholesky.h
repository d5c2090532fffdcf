// Cholesky decomposition of small matrices of fixed size, written as loops.
//
// Eigen's version takes seconds to compile for every size, and at run time calls kernels made for
// large matrices. The compiler unrolls these loops.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace palpate {

/// L, lower triangular, with L L^T = the matrix whose lower triangle is in `symmetric`. False if a
/// pivot is not positive. NaN is not detected; it appears in L.
template <int N>
bool cholesky(const Eigen::Matrix<double, N, N>& symmetric, Eigen::Matrix<double, N, N>* lower) {
  Eigen::Matrix<double, N, N>& l = *lower;
  for (int j = 0; j < N; ++j) {
    double pivot = symmetric(j, j);
    for (int k = 0; k < j; ++k) {
      pivot -= l(j, k) * l(j, k);
      l(k, j) = 0.0;
    }
    if (pivot <= 0.0) {
      return false;
    }
    l(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i) {
      double sum = symmetric(i, j);
      for (int k = 0; k < j; ++k) {
        sum -= l(i, k) * l(j, k);
      }
      l(i, j) = sum / l(j, j);
    }
  }
  return true;
}

/// The x with L x = b, using the leading Size rows and columns of L.
template <int Size, int N>
Eigen::Matrix<double, Size, 1> solve_lower(const Eigen::Matrix<double, N, N>& lower,
                                           Eigen::Matrix<double, Size, 1> b) {
  for (int i = 0; i < Size; ++i) {
    for (int k = 0; k < i; ++k) {
      b[i] -= lower(i, k) * b[k];
    }
    b[i] /= lower(i, i);
  }
  return b;
}

/// Replaces B by the X with L X = B, for all columns at once.
template <int N, int Columns>
void solve_lower_rows(const Eigen::Matrix<double, N, N>& lower,
                      Eigen::Matrix<double, N, Columns, Eigen::RowMajor>* b) {
  for (int i = 0; i < N; ++i) {
    Eigen::Matrix<double, 1, Columns> row = b->row(i);
    for (int k = 0; k < i; ++k) {
      row -= lower(i, k) * b->row(k);
    }
    b->row(i) = row * (1.0 / lower(i, i));
  }
}

/// The x with L^T x = b, using the leading Size rows and columns of L.
template <int Size, int N>
Eigen::Matrix<double, Size, 1> solve_lower_transposed(const Eigen::Matrix<double, N, N>& lower,
                                                      Eigen::Matrix<double, Size, 1> b) {
  for (int i = Size - 1; i >= 0; --i) {
    for (int k = i + 1; k < Size; ++k) {
      b[i] -= lower(k, i) * b[k];
    }
    b[i] /= lower(i, i);
  }
  return b;
}

/// The x with L L^T x = b.
template <int N>
Eigen::Matrix<double, N, 1> solve_cholesky(const Eigen::Matrix<double, N, N>& lower,
                                           const Eigen::Matrix<double, N, 1>& b) {
  return solve_lower_transposed<N>(lower, solve_lower<N>(lower, b));
}

/// L^-1, lower triangular.
template <int N>
Eigen::Matrix<double, N, N> inverse_lower(const Eigen::Matrix<double, N, N>& lower) {
  Eigen::Matrix<double, N, N> inverse = Eigen::Matrix<double, N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    for (int i = j; i < N; ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k) {
        sum -= lower(i, k) * inverse(k, j);
      }
      inverse(i, j) = sum / lower(i, i);
    }
  }
  return inverse;
}

/// (L L^T)^-1.
template <int N>
Eigen::Matrix<double, N, N> inverse_cholesky(const Eigen::Matrix<double, N, N>& lower) {
  const Eigen::Matrix<double, N, N> rows = inverse_lower<N>(lower);
  Eigen::Matrix<double, N, N> inverse;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = i; k < N; ++k) {
        sum += rows(k, i) * rows(k, j);
      }
      inverse(i, j) = inverse(j, i) = sum;
    }
  }
  return inverse;
}

}  // namespace palpate
