// What the recognition tree was asked on its way.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "core/curves/curve_class.h"

namespace palpate {

/// One query of the recognition tree (section 5.2).
struct Decision {
  std::string_view test;  ///< e.g. "conic line"; static storage
  double value = 0.0;
  double threshold = 0.0;
  bool passed = false;
  /// Probability that chance alone makes the value as large where the class is true; NaN where a
  /// tolerance decides.
  double p_value = std::numeric_limits<double>::quiet_NaN();
};

/// By class, the least p-value of the tests that it must pass; NaN where none was made.
using ClassPValues = std::array<double, kCurveClasses.size() + 1>;

constexpr ClassPValues no_p_values() {
  ClassPValues none{};
  none.fill(std::numeric_limits<double>::quiet_NaN());
  return none;
}

}  // namespace palpate
