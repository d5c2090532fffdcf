// Slope and arc length of the graph of a polynomial in Legendre's basis.
#pragma once

#include <array>
#include <cmath>

#include "core/numerics/polynomials/legendre_fit.h"

namespace palpate {

/// Gauss-Legendre nodes and weights on [-1, 1].
inline constexpr std::array<double, 5> kGaussNodes = {
    -0.906179845938663993, -0.538469310105683091, 0.0, 0.538469310105683091, 0.906179845938663993};
inline constexpr std::array<double, 5> kGaussWeights = {0.236926885056189088, 0.478628670499366468,
                                                        0.568888888888888889, 0.478628670499366468,
                                                        0.236926885056189088};

/// Slope of the polynomial with Legendre coefficients c. p holds P_0 ... P_{Size-2} (and possibly
/// more) at the abscissa.
template <int Size, int Terms>
double slope_of(const LegendreVector<Size>& c, const LegendreVector<Terms>& p) {
  static_assert(Terms + 1 >= Size);
  // P'_{k+1} = P'_{k-1} + (2k + 1) P_k
  double d_before = 0.0;
  double d = 0.0;
  double sum = 0.0;
  for (int k = 0; k + 1 < Size; ++k) {
    const double d_next = d_before + (2 * k + 1) * p[k];
    d_before = d;
    d = d_next;
    sum += c[k + 1] * d;
  }
  return sum;
}

/// Slope at the abscissa u.
template <int Size>
double slope(const LegendreVector<Size>& c, double u) {
  return slope_of<Size, Size>(c, legendre<Size>(u));
}

/// Arc length of the polynomial from u0 to u1.
template <int Size>
double arc_length(const LegendreVector<Size>& c, double u0, double u1) {
  const double middle = 0.5 * (u0 + u1);
  const double half = 0.5 * (u1 - u0);
  double sum = 0.0;
  for (std::size_t i = 0; i < kGaussNodes.size(); ++i) {
    sum += kGaussWeights[i] * std::hypot(1.0, slope<Size>(c, middle + half * kGaussNodes[i]));
  }
  return half * sum;
}

}  // namespace palpate
