// Sums of numbers that are given as logarithms.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

/// log(exp(a) + exp(b)) without overflow; -infinity stands for 0.
inline double log_add(double a, double b) {
  const double top = std::max(a, b);
  return std::isfinite(top) ? top + std::log(std::exp(a - top) + std::exp(b - top)) : top;
}

}  // namespace palpate
