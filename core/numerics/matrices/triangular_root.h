// A square root of a sum of squares, updated row by row.
//
// J^T J has only half of the digits of J. If the rows determine one direction 10^8 times better
// than another, the Cholesky factor of J^T J contains only rounding for that other direction.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace palpate {

/// Replaces `lower`, lower triangular with a positive diagonal, by the L with L L^T = lower lower^T
/// + rows^T rows, using Householder reflections. `rows` is overwritten. NaN and infinity appear in
/// L.
template <int Rows, int N>
void absorb_rows(Eigen::Matrix<double, Rows, N>* rows, Eigen::Matrix<double, N, N>* lower) {
  auto& l = *lower;
  for (int k = 0; k < N; ++k) {
    const double square = rows->col(k).squaredNorm();
    if (square == 0.0) {
      continue;
    }
    const double norm = std::sqrt(l(k, k) * l(k, k) + square);
    const double pivot = l(k, k) + norm;
    l(k, k) = norm;
    for (int j = k + 1; j < N; ++j) {
      const double part = (pivot * l(j, k) + rows->col(k).dot(rows->col(j))) / (norm * pivot);
      l(j, k) = part * pivot - l(j, k);
      rows->col(j) -= part * rows->col(k);
    }
  }
}

/// The root of the same sum, with row and column k replaced by those of the identity.
template <int N>
Eigen::Matrix<double, N, N> root_without(Eigen::Matrix<double, N, N> lower, int k) {
  // Without its entry k, column k acts as one more row for the directions after it.
  Eigen::Matrix<double, 1, N> row = Eigen::Matrix<double, 1, N>::Zero();
  for (int j = k + 1; j < N; ++j) {
    row[j] = lower(j, k);
  }
  lower.row(k).setZero();
  lower.col(k).setZero();
  lower(k, k) = 1.0;
  absorb_rows<1, N>(&row, &lower);
  return lower;
}

}  // namespace palpate
