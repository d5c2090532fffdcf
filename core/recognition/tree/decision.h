// The tests of the recognition tree and their results.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "core/curves/curve_class.h"

namespace palpate {

/// One test of the recognition tree (section 5.2).
struct Decision {
  std::string_view test;  ///< e.g. "conic line"; static storage
  double value = 0.0;
  double threshold = 0.0;
  bool passed = false;
  /// Probability of a value at least as large if the class is true; NaN if a tolerance decides.
  double p_value = std::numeric_limits<double>::quiet_NaN();
};

/// By class: smallest p-value of the tests that the class must pass; NaN without a test.
using ClassPValues = ByClass<double>;

constexpr ClassPValues no_p_values() {
  ClassPValues none{};
  none.fill(std::numeric_limits<double>::quiet_NaN());
  return none;
}

}  // namespace palpate
