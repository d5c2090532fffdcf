#include "core/recognition/normal_quantile.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace palpate {

double two_sided_normal_quantile(double probability) {
  assert(probability > 0.0 && probability < 1.0);
  // Bisection on erfc, monotone: z beyond 38 has a probability below the smallest double.
  double low = 0.0;
  double high = 38.0;
  constexpr int kBisections = 60;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::numbers::sqrt2) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace palpate
