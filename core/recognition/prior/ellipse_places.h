// How probable it is that an ellipse is touched at a place: by its share of the perimeter.
#pragma once

#include <cmath>

#include "core/curves/pose2.h"

namespace palpate {

/// A quarter of an ellipse's perimeter over a, m = b^2 / a^2, right to 4e-4 (S. Ramanujan, 1914).
inline double quarter_perimeter_over_a(double m) {
  const double ratio = std::sqrt(m);
  const double flattening = (1.0 - ratio) / (1.0 + ratio);
  const double square = 3.0 * flattening * flattening;
  return 0.25 * kPi * (1.0 + ratio) * (1.0 + square / (10.0 + std::sqrt(4.0 - square)));
}

/// Derivative of its logarithm by m.
inline double log_quarter_perimeter_derivative(double m) {
  const double ratio = std::sqrt(m);
  const double flattening = (1.0 - ratio) / (1.0 + ratio);
  const double square = 3.0 * flattening * flattening;
  const double root = std::sqrt(4.0 - square);
  const double below = 10.0 + root;
  const double by_square = (below + 0.5 * square / root) / (below * below);
  const double by_ratio = -12.0 * flattening / ((1.0 + ratio) * (1.0 + ratio));
  return (1.0 / (1.0 + ratio) + by_square * by_ratio / (1.0 + square / below)) / (2.0 * ratio);
}

/// What curvature on an ellipse is the power 3 / 2 of, 1 at its tips: by the tangent's direction
/// from the major axis.
inline double tip_likeness(double m, double direction) {
  const double sine = std::sin(direction);
  return sine * sine + m * (1.0 - sine * sine);
}

/// Width of the law of directions at a place, as prior_widths. A pose turned by half a turn is the
/// same: half of it is all.
inline double width_of_direction(double m) {
  return 2.0 * quarter_perimeter_over_a(m) * std::sqrt(m) / std::sqrt(2.0 * kPi);
}

}  // namespace palpate
