// Positions of the marks on a chart's axis.
#pragma once

#include <cmath>

namespace palpate {

/// 1, 2 or 5 times a power of ten, such that about `count` ticks fit the length.
inline double tick_step(double length, double count) {
  const double rough = length / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

}  // namespace palpate
