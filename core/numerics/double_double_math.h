// What algorithms written for double and DoubleDouble alike need beyond sums and products.
#pragma once

#include <cmath>

#include "core/numerics/double_double.h"

namespace palpate {

/// Quotient to twice the precision of a double: the double's quotient, corrected once.
inline DoubleDouble operator/(const DoubleDouble& u, const DoubleDouble& v) {
  const double first = u.high / v.high;
  const DoubleDouble rest = u - v * DoubleDouble(first);
  return DoubleDouble(first) + DoubleDouble(rest.high / v.high);
}

/// Square root to twice the precision of a double: the double's root, corrected once by Newton.
inline DoubleDouble sqrt(const DoubleDouble& u) {
  const double first = std::sqrt(u.high);
  if (!(first > 0.0)) {
    return DoubleDouble(first);  // 0, or no root: NaN
  }
  const DoubleDouble rest = u - DoubleDouble(first) * DoubleDouble(first);
  return DoubleDouble(first) + DoubleDouble(0.5 * rest.high / first);
}

inline double to_double(double value) { return value; }
inline double to_double(const DoubleDouble& value) { return static_cast<double>(value); }

}  // namespace palpate
