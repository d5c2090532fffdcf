#include "core/recognition/chi_square.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {

double chi_square_survival(double chi2, int dof) {
  if (dof <= 0 || !(chi2 > 0.0)) {
    return 1.0;
  }
  // Q(x; 1) = erfc(sqrt(x / 2)), Q(x; 2) = exp(-x / 2) and
  // Q(x; k + 2) = Q(x; k) + (x / 2)^(k / 2) exp(-x / 2) / Gamma(k / 2 + 1).
  const double half = 0.5 * chi2;
  const bool odd = dof % 2 == 1;
  double survival = odd ? std::erfc(std::sqrt(half)) : std::exp(-half);
  const double log_half = std::log(half);
  for (int k = odd ? 1 : 2; k < dof; k += 2) {
    survival += std::exp(0.5 * k * log_half - half - std::lgamma(0.5 * k + 1.0));
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
  const double log_norm = std::lgamma(0.5 * k) + std::log(2.0);
  double low = 0.0;
  double high = k + 2.0 * std::sqrt(-k * log_significance) - 2.0 * log_significance;
  double x = high;
  constexpr int kMostIterations = 200;
  constexpr double kRelativeStep = 1e-14;
  for (int i = 0; i < kMostIterations && high - low > kRelativeStep * high; ++i) {
    const double survival = chi_square_survival(x, dof);
    (survival > significance ? low : high) = x;
    const double density = std::exp((0.5 * k - 1.0) * std::log(0.5 * x) - 0.5 * x - log_norm);
    const double next = x + (std::log(survival) - log_significance) * survival / density;
    const double before = x;
    x = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(x - before) <= kRelativeStep * x) {
      break;
    }
  }
  return x;
}

}  // namespace palpate
