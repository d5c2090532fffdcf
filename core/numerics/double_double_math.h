// Division and square root of DoubleDouble, so that one algorithm can be written for double and
// DoubleDouble.
#pragma once

#include <cmath>

#include "core/numerics/double_double.h"

namespace palpate {

/// Quotient in twice the precision of a double: the quotient of doubles, corrected once.
inline DoubleDouble operator/(const DoubleDouble& u, const DoubleDouble& v) {
  const double first = u.high / v.high;
  const DoubleDouble rest = u - v * DoubleDouble(first);
  return DoubleDouble(first) + DoubleDouble(rest.high / v.high);
}

/// Square root in twice the precision of a double: the root of the double, with one Newton
/// correction.
inline DoubleDouble sqrt(const DoubleDouble& u) {
  const double first = std::sqrt(u.high);
  if (!(first > 0.0)) {
    return DoubleDouble(first);  // 0, or NaN for a negative number
  }
  const DoubleDouble rest = u - DoubleDouble(first) * DoubleDouble(first);
  return DoubleDouble(first) + DoubleDouble(0.5 * rest.high / first);
}

inline double to_double(double value) { return value; }
inline double to_double(const DoubleDouble& value) { return static_cast<double>(value); }

}  // namespace palpate
