#include "core/numerics/chi_square.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/numerics/log_gamma.h"

namespace palpate {
namespace {

/// n log(n / h) + h - n >= 0, without the cancellation where n and h are near: with v = (n - h) /
/// (n + h) it is (n - h) v + 2 n (v^3 / 3 + v^5 / 5 + ...).
double log_deviance(double n, double h) {
  const double v = (n - h) / (n + h);
  constexpr double kNear = 0.1;  // the series gains two digits a term
  if (std::abs(v) >= kNear) {
    return n * std::log(n / h) + h - n;
  }
  double sum = (n - h) * v;
  double power = 2.0 * n * v;
  for (int j = 3;; j += 2) {
    power *= v * v;
    const double next = sum + power / j;
    if (next == sum) {
      return sum;
    }
    sum = next;
  }
}

/// log(Gamma(n + 1)) less Stirling's log(sqrt(2 pi n) (n / e)^n).
double stirling_error(double n) {
  constexpr double kSeries = 16.0;  // the first term left out is below 1e-16 from here on
  if (n < kSeries) {
    return log_gamma(n + 1.0) - (n + 0.5) * std::log(n) + n -
           0.5 * std::log(2.0 * std::numbers::pi);
  }
  const double u = 1.0 / (n * n);
  return (1.0 / 12.0 - u * (1.0 / 360.0 -
                            u * (1.0 / 1260.0 -
                                 u * (1.0 / 1680.0 - u * (1.0 / 1188.0 - u * 691.0 / 360360.0))))) /
         n;
}

/// h^n exp(-h) / Gamma(n + 1), n > 0, to a few units in the last place however large n and h are:
/// the logarithms of its factors would lose the digits of their size.
double poisson_term(double n, double h) {
  return std::exp(-log_deviance(n, h) - stirling_error(n)) / std::sqrt(2.0 * std::numbers::pi * n);
}

}  // namespace

double chi_square_survival(double chi2, int dof) {
  if (dof <= 0 || !(chi2 > 0.0)) {
    return 1.0;
  }
  if (std::isinf(chi2)) {
    return 0.0;
  }
  // Q(x; 1) = erfc(sqrt(x / 2)), Q(x; 2) = exp(-x / 2) and
  // Q(x; k + 2) = Q(x; k) + (x / 2)^(k / 2) exp(-x / 2) / Gamma(k / 2 + 1).
  const double half = 0.5 * chi2;
  const bool odd = dof % 2 == 1;
  double survival = odd ? std::erfc(std::sqrt(half)) : std::exp(-half);
  for (int k = odd ? 1 : 2; k < dof; k += 2) {
    survival += poisson_term(0.5 * k, half);
  }
  return std::min(survival, 1.0);
}

double chi_square_threshold(double significance, int dof) {
  assert(significance > 0.0 && significance < 1.0);
  if (dof <= 0) {
    return 0.0;
  }
  // Newton's method for log Q(x) = log(significance), from above: P(chi2 > k + 2 sqrt(k u) + 2 u)
  // <= exp(-u) (B. Laurent, P. Massart, 2000). -Q' is the density.
  const double k = dof;
  const double log_significance = std::log(significance);
  const double log_norm = log_gamma(0.5 * k) + std::log(2.0);
  double low = 0.0;
  double high = k + 2.0 * std::sqrt(-k * log_significance) - 2.0 * log_significance;
  double x = high;
  // The error of a step is about its square: one this small leaves rounding.
  constexpr double kRelativeStep = 1e-8;
  constexpr double kRounding = 1e-14;
  constexpr int kMostIterations = 200;
  for (int i = 0; i < kMostIterations && high - low > kRounding * high; ++i) {
    const double survival = chi_square_survival(x, dof);
    (survival > significance ? low : high) = x;
    const double density = std::exp((0.5 * k - 1.0) * std::log(0.5 * x) - 0.5 * x - log_norm);
    const double next = x + (std::log(survival) - log_significance) * survival / density;
    if (std::abs(next - x) <= kRelativeStep * x) {
      return next;
    }
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

}  // namespace palpate
