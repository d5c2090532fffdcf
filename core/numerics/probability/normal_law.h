// Quantiles and truncated moments of the standard normal distribution.
#pragma once

#include <cmath>
#include <numbers>

namespace palpate {

/// Median of |normal variable|.
inline constexpr double kMedianOfNormal = 0.6744897501960817;

/// Median of the length of two normal variables, sqrt(2 ln 2).
inline constexpr double kMedianInPlane = 1.1774100225154747;

/// The z that |normal variable| exceeds with `probability` in (0, 1]. Newton's method on the
/// logarithm of erfc, which is concave, starting from the leading term of the tail. Relative error
/// below 1e-12 for probabilities down to 1e-300.
inline double two_sided_normal_quantile(double probability) {
  if (!(probability < 1.0)) {
    return 0.0;
  }
  const double target = std::log(probability);
  double z = std::sqrt(-2.0 * target);
  for (int i = 0; i < 60; ++i) {
    const double tail = std::erfc(z / std::numbers::sqrt2);
    const double density =
        std::sqrt(2.0 * std::numbers::inv_pi) * std::exp(-0.5 * z * z);  // -d tail / dz
    const double step = (std::log(tail) - target) * tail / density;
    z += step;
    if (std::abs(step) <= 1e-14 * z) {
      break;
    }
  }
  return z;
}

/// Mean square of a standard normal variable x given |x| <= cut, cut > 0.
inline double mean_square_within(double cut) {
  const double density = std::exp(-0.5 * cut * cut) / std::sqrt(2.0 * std::numbers::pi);
  return 1.0 - 2.0 * cut * density / std::erf(cut / std::numbers::sqrt2);
}

}  // namespace palpate
