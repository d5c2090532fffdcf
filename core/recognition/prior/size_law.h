// How large a part is beside what is touched of it.
#pragma once

#include <cmath>
#include <numbers>

namespace palpate {

/// What is touched of a part is between a tenth of its size (half the diagonal of its box) and all
/// of it: the size is 1 to 20 half extents, half way on the logarithm. Sizes far from that fall off
/// as the square of their own power: the law of log(size) is the square of a hyperbolic secant.
inline const double kLogSize = 0.5 * std::log(20.0);

/// log of the density of x = log(size) - kLogSize, over the one at 0. That is 1 / 2.
inline double log_of_size(double x) {
  // -2 log cosh without overflow.
  const double away = std::abs(x);
  return -2.0 * (away + std::log1p(std::exp(-2.0 * away)) - std::numbers::ln2);
}
inline double log_of_size_derivative(double x) { return -2.0 * std::tanh(x); }

/// log of half the diagonal of an ellipse's box, or of half the distance of a hyperbola's foci,
/// over p, m = b^2 / a^2, and its derivative.
inline double log_diagonal_over_p(double m) { return 0.5 * std::log1p(m) - std::log(m); }
inline double log_diagonal_derivative(double m) { return 0.5 / (1.0 + m) - 1.0 / m; }

}  // namespace palpate
