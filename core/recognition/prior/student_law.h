// Student's law: of a power's tails.
#pragma once

#include <cmath>

#include "core/curves/pose2.h"

namespace palpate {

/// Student's law of `freedom` degrees of freedom about 0. Its density goes as
/// (1 + (x / scale)^2)^(-(freedom + 1) / 2).
struct StudentLaw {
  int freedom = 1;
  double scale = 1.0;

  /// Of (1 + x^2)^(-(freedom + 1) / 2).
  static double integral(int freedom) {
    return freedom == 1   ? kPi
           : freedom == 2 ? 2.0
                          : integral(freedom - 2) * (freedom - 2.0) / (freedom - 1.0);
  }
  /// Standard deviation of the normal law with the same height at 0.
  double width() const { return scale * integral(freedom) / std::sqrt(2.0 * kPi); }
  /// log of the density over the one at 0.
  double log(double x) const {
    return -0.5 * (freedom + 1.0) * std::log1p(x * x / (scale * scale));
  }
  double derivative(double x) const { return -(freedom + 1.0) * x / (scale * scale + x * x); }
};

}  // namespace palpate
