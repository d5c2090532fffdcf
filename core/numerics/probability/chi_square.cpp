#include "core/numerics/probability/chi_square.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/numerics/probability/log_gamma.h"

namespace palpate {
namespace {

/// n log(n / h) + h - n >= 0, without cancellation for n near h: with v = (n - h) / (n + h) it is
/// (n - h) v + 2 n (v^3 / 3 + v^5 / 5 + ...).
double log_deviance(double n, double h) {
  const double v = (n - h) / (n + h);
  constexpr double kNear = 0.1;  // the series gains two digits per term
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

/// log(Gamma(n + 1)) minus Stirling's log(sqrt(2 pi n) (n / e)^n).
double stirling_error(double n) {
  constexpr double kSeries = 16.0;  // from here on the first omitted term is below 1e-16
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

/// h^n exp(-h) / Gamma(n + 1), n > 0, to a few units in the last place, for n and h of any size.
/// The sum of the logarithms of its factors would lose digits.
double poisson_term(double n, double h) {
  return std::exp(-log_deviance(n, h) - stirling_error(n)) / std::sqrt(2.0 * std::numbers::pi * n);
}

/// Q(x; dof), and -dQ/dx.
struct Tail {
  double survival = 0.0;
  double density = 0.0;
};

/// For dof > 0 and a finite x > 0. With h = x / 2: Q(x; 1) = erfc(sqrt(h)), Q(x; 2) = exp(-h) and
/// Q(x; k + 2) = Q(x; k) + h^n exp(-h) / Gamma(n + 1), n = k / 2, where each term is h / n times
/// the one before.
Tail tail_of(double x, int dof) {
  constexpr int kRenewed = 32;       // after so many products a term has lost a digit
  constexpr double kLeast = 1e-290;  // a smaller product may have lost all digits
  const double half = 0.5 * x;
  const bool odd = dof % 2 == 1;
  double n = odd ? -0.5 : 0.0;
  double term = std::exp(-half);
  double survival = term;
  if (odd) {
    survival = std::erfc(std::sqrt(half));
    term /= std::sqrt(std::numbers::pi * half);
  }
  for (int k = odd ? 1 : 2, products = 1; k < dof; k += 2, ++products) {
    n += 1.0;
    const bool renew = products % kRenewed == 0 || term < kLeast;
    term = renew ? poisson_term(n, half) : term * (half / n);
    survival += term;
  }
  return {std::min(survival, 1.0), 0.5 * term};
}

/// E. B. Wilson, M. M. Hilferty (1931): the cube root of chi-square divided by its degrees of
/// freedom is nearly normal. The normal quantile is C. Hastings' rational approximation (1955), to
/// 5e-4.
double approximate_threshold(double significance, int dof) {
  const double upper = std::min(significance, 1.0 - significance);
  const double t = std::sqrt(-2.0 * std::log(upper));
  const double quantile = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                                  (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  const double variance = 2.0 / (9.0 * dof);
  const double root =
      1.0 - variance + std::copysign(quantile, 0.5 - significance) * std::sqrt(variance);
  return dof * root * root * root;
}

}  // namespace

double chi_square_survival(double chi2, int dof) {
  if (dof <= 0 || chi2 <= 0.0) {
    return 1.0;
  }
  if (std::isnan(chi2)) {
    return chi2;
  }
  return std::isinf(chi2) ? 0.0 : tail_of(chi2, dof).survival;
}

double chi_square_threshold(double significance, int dof) {
  assert(significance > 0.0 && significance < 1.0);
  if (dof <= 0) {
    return 0.0;
  }
  // Newton's method for log Q(x) = log(significance), starting below the bound P(chi2 > k + 2
  // sqrt(k u) + 2 u) <= exp(-u) (B. Laurent, P. Massart, 2000).
  const double k = dof;
  const double log_significance = std::log(significance);
  double low = 0.0;
  double high = k + 2.0 * std::sqrt(-k * log_significance) - 2.0 * log_significance;
  double x = approximate_threshold(significance, dof);
  x = x > low && x < high ? x : high;
  // The error after a step is about the square of the step: after so small a step only rounding
  // remains.
  constexpr double kRelativeStep = 1e-8;
  constexpr double kRounding = 1e-14;
  constexpr int kMostIterations = 200;
  for (int i = 0; i < kMostIterations && high - low > kRounding * high; ++i) {
    const auto [survival, density] = tail_of(x, dof);
    (survival > significance ? low : high) = x;
    const double next = x + (std::log(survival) - log_significance) * survival / density;
    if (std::abs(next - x) <= kRelativeStep * x) {
      return next;
    }
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

}  // namespace palpate
