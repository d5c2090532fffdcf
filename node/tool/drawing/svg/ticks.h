// Positions of the marks on a chart's axis.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

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

/// What the labels of an axis are less: 0 where six digits tell its ticks apart without an
/// exponent, else a round number near the axis.
inline double tick_offset(double from, double to, double step) {
  constexpr double kMostSteps = 1e5;  // that six digits count, of which one may be half a step's
  constexpr double kExponent = 1e6;   // from which on six digits have one
  const double largest = std::max(std::abs(from), std::abs(to));
  if (largest < std::min(kMostSteps * step, kExponent)) return 0.0;
  const double grid = std::pow(10.0, std::ceil(std::log10(10.0 * (to - from))));
  return std::round(0.5 * (from + to) / grid) * grid;
}

/// "x [mm]"; "x - 9900000 [mm]" where the labels are less that.
inline std::string axis_title(const char* name, double offset, double step, const char* unit) {
  if (offset == 0.0) return std::string(name) + " [" + unit + "]";
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step))) - 1);
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, std::abs(offset));
  return std::string(name) + (offset > 0.0 ? " - " : " + ") + text + " [" + unit + "]";
}

}  // namespace palpate
