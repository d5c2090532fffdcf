// Least-squares polynomials from moments: the coarse search compares its trials by them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/numerics/matrices/small_cholesky.h"

namespace palpate {

/// Weighted moments for a least-squares polynomial in u of degree 3: sums of w u^k and w v u^k.
/// Even and odd powers in pairs: two doubles are processed at once.
struct SeedMoments {
  using Pair = Eigen::Array2d;
  std::array<Pair, 4> u = {Pair::Zero(), Pair::Zero(), Pair::Zero(), Pair::Zero()};
  std::array<Pair, 2> vu = {Pair::Zero(), Pair::Zero()};
  double vv = 0.0;

  /// `x2` is x^2.
  void add(double w, double x, double x2, double v) {
    Pair powers(w, w * x);
    vv += w * v * v;
    u[0] += powers;
    vu[0] += v * powers;
    powers *= x2;
    u[1] += powers;
    vu[1] += v * powers;
    powers *= x2;
    u[2] += powers;
    powers *= x2;
    u[3] += powers;
  }

  /// Adds another patch's moments, on the arm of the given sign: u -> sign u.
  void add(const SeedMoments& other, double sign) {
    const Pair signs(1.0, sign);
    for (std::size_t k = 0; k < 4; ++k) {
      u[k] += signs * other.u[k];
    }
    for (std::size_t k = 0; k < 2; ++k) {
      vu[k] += signs * other.vu[k];
    }
    vv += other.vv;
  }

  double of_u(std::size_t k) const { return u[k / 2][static_cast<Eigen::Index>(k % 2)]; }
  double of_vu(std::size_t k) const { return vu[k / 2][static_cast<Eigen::Index>(k % 2)]; }
};

/// Ridge at the level of rounding, for nearly empty directions (all points alike).
inline constexpr double kSeedRidge = 1e-12;

/// Residual sums of squares of two models, with three and with four powers.
struct ResidualSums {
  double of_three = std::numeric_limits<double>::infinity();
  double of_four = std::numeric_limits<double>::infinity();
};

/// Least squares of v over the first three and over all four powers of u, in the given order.
inline ResidualSums residual_sums(const SeedMoments& m, const std::array<std::size_t, 4>& powers) {
  constexpr std::size_t kRight = 4;
  // Gaussian elimination of the normal equations: each pivot reduces the sum of squares.
  std::array<std::array<double, 5>, 4> rows;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i; j < 4; ++j) {
      rows[i][j] = m.of_u(powers[i] + powers[j]);
    }
    rows[i][i] += kSeedRidge * m.of_u(2 * powers[i]);
    rows[i][kRight] = m.of_vu(powers[i]);
  }
  const auto at_least_zero = [](double cost) {
    return std::isfinite(cost) ? std::max(cost, 0.0) : std::numeric_limits<double>::infinity();
  };
  ResidualSums sums;
  double cost = m.vv;
  for (std::size_t k = 0; k < 4; ++k) {
    if (rows[k][k] > 0.0) {
      const double inverse = 1.0 / rows[k][k];
      for (std::size_t i = k + 1; i < 4; ++i) {
        const double factor = rows[k][i] * inverse;
        for (std::size_t j = i; j <= kRight; ++j) {
          rows[i][j] -= factor * rows[k][j];
        }
      }
      cost -= rows[k][kRight] * rows[k][kRight] * inverse;
    }
    if (k == 2) {
      sums.of_three = at_least_zero(cost);
    }
  }
  sums.of_four = at_least_zero(cost);
  return sums;
}

/// Least squares of v over all four powers of u; element k is the coefficient of u^k.
inline std::array<double, 4> coefficients(const SeedMoments& m) {
  Eigen::Matrix4d normal;
  Eigen::Vector4d right;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < 4; ++j) {
      normal(row, static_cast<Eigen::Index>(j)) = m.of_u(i + j);
    }
    normal(row, row) *= 1.0 + kSeedRidge;
    right[row] = m.of_vu(i);
  }
  Eigen::Matrix4d factor;
  if (!cholesky(normal, &factor)) {
    return {};
  }
  const Eigen::Vector4d y = solve_cholesky(factor, right);
  return {y[0], y[1], y[2], y[3]};
}

/// A quarter of the sum of squares by which a patch fits better on the positive arm than on the
/// negative one; its moments are those of the positive arm. With the even part e and the odd part o
/// of y(u) the residuals are v - e - o and v - e + o, so this is the sum of w o (v - e).
inline double advantage_of_positive_arm(const SeedMoments& m, const std::array<double, 4>& y) {
  return y[1] * (m.of_vu(1) - y[0] * m.of_u(1) - y[2] * m.of_u(3)) +
         y[3] * (m.of_vu(3) - y[0] * m.of_u(3) - y[2] * m.of_u(5));
}

}  // namespace palpate
