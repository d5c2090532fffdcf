// The normal equations of a polynomial in Legendre's basis, from one sum per degree: a product of
// two Legendre polynomials is a sum of Legendre polynomials.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>

namespace palpate {

/// P_first P_second = sum over r = 0 ... min(first, second) of product_coefficient(first, second,
/// r) P_{first + second - 2r} (J. C. Adams, 1878). No coefficient is negative and their sum is 1,
/// so the sum cancels no more than the product itself does.
constexpr double product_coefficient(int first, int second, int r) {
  // (2k - 1)!! / k!
  const auto leading = [](int k) {
    double value = 1.0;
    for (int i = 1; i <= k; ++i) {
      value *= (2.0 * i - 1.0) / i;
    }
    return value;
  };
  const int sum = first + second;
  return leading(r) * leading(first - r) * leading(second - r) / leading(sum - r) *
         (2.0 * sum - 4.0 * r + 1.0) / (2.0 * sum - 2.0 * r + 1.0);
}

/// For points (u, v) with weights w: the sums of w P_0(u) ... w P_{Terms-1}(u), and of w v P_0(u)
/// ... w v P_{Moments-1}(u). A point costs Terms + Moments products, where the matrix of a fit
/// needs the square of that.
template <int Terms, int Moments>
class LegendreSums {
 public:
  static_assert(Moments <= Terms && Terms >= 2);
  /// Number of points processed at once. The columns must have a multiple of it.
  static constexpr std::size_t kLanes = 4;
  using Lanes = Eigen::Array<double, static_cast<int>(kLanes), 1>;

  LegendreSums(std::span<const double> u, std::span<const double> v, std::span<const double> w) {
    assert(u.size() % kLanes == 0 && v.size() == u.size() && w.size() == u.size());
    std::array<Lanes, Terms> sums;
    std::array<Lanes, Moments> moments;
    sums.fill(Lanes::Zero());
    moments.fill(Lanes::Zero());
    for (std::size_t i = 0; i < u.size(); i += kLanes) {
      const Lanes at = Eigen::Map<const Lanes>(&u[i]);
      const Lanes weight = Eigen::Map<const Lanes>(&w[i]);
      const Lanes product = weight * Eigen::Map<const Lanes>(&v[i]);
      Lanes before = Lanes::Ones();
      Lanes now = at;
      sums[0] += weight;
      moments[0] += product;
      [&]<std::size_t... K>(std::index_sequence<K...>) {
        (add<K + 1>(weight, product, at, &before, &now, &sums, &moments), ...);
      }
      (std::make_index_sequence<Terms - 1>());
    }
    for (std::size_t k = 0; k < Terms; ++k) {
      sums_[k] = sums[k].sum();
    }
    for (std::size_t k = 0; k < Moments; ++k) {
      moments_[static_cast<Eigen::Index>(k)] = moments[k].sum();
    }
  }

  double weight() const { return sums_[0]; }
  /// Sums of w v P_k.
  const Eigen::Matrix<double, Moments, 1>& moments() const { return moments_; }

  /// Sums of w P_j P_k for rows j = 0 ... Rows - 1 and columns k = FirstColumn ... FirstColumn +
  /// Columns - 1. If FirstColumn is 0, only the lower triangle is set.
  template <int Rows, int Columns, int FirstColumn = 0>
  Eigen::Matrix<double, Rows, Columns> products() const {
    static_assert(Rows + FirstColumn + Columns - 1 <= Terms);
    Eigen::Matrix<double, Rows, Columns> matrix;
    [&]<int... K>(std::integer_sequence<int, K...>) {
      constexpr bool kIsSquare = FirstColumn == 0;
      (products_of_column<Rows, FirstColumn + K, int{kIsSquare} * K>(matrix.col(K).data()), ...);
    }
    (std::make_integer_sequence<int, Columns>());
    return matrix;
  }

 private:
  /// Adds the terms of degree K, and computes P_{K+1} for the next call.
  template <std::size_t K>
  static void add(const Lanes& weight, const Lanes& product, const Lanes& u, Lanes* before,
                  Lanes* now, std::array<Lanes, Terms>* sums, std::array<Lanes, Moments>* moments) {
    (*sums)[K] += weight * *now;
    if constexpr (K < Moments) {
      (*moments)[K] += product * *now;
    }
    if constexpr (K + 1 < Terms) {
      constexpr double kDegree = K;
      const Lanes next =
          (2.0 * kDegree + 1.0) / (kDegree + 1.0) * u * *now - kDegree / (kDegree + 1.0) * *before;
      *before = *now;
      *now = next;
    }
  }

  // Unrolled, with coefficients that are known at compile time.
  template <int Rows, int Degree, int FirstRow>
  void products_of_column(double* column) const {
    [&]<int... J>(std::integer_sequence<int, J...>) {
      ((column[FirstRow + J] = product<FirstRow + J, Degree>()), ...);
    }
    (std::make_integer_sequence<int, Rows - FirstRow>());
  }
  template <int First, int Second>
  double product() const {
    return [&]<int... R>(std::integer_sequence<int, R...>) {
      return (term<First, Second, R>() + ...);
    }
    (std::make_integer_sequence<int, std::min(First, Second) + 1>());
  }
  template <int First, int Second, int R>
  double term() const {
    constexpr double kCoefficient = product_coefficient(First, Second, R);
    return kCoefficient * sums_[static_cast<std::size_t>(First + Second - 2 * R)];
  }

  std::array<double, Terms> sums_{};
  Eigen::Matrix<double, Moments, 1> moments_;
};

}  // namespace palpate
