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
  double low = 0.0;
  double high = dof + 10.0;
  while (chi_square_survival(high, dof) > significance) {
    low = high;
    high *= 2.0;
  }
  for (int i = 0; i < 200 && high - low > 1e-13 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi_square_survival(middle, dof) > significance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace palpate
