// The middle one of a set of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace palpate {

/// The median; of an even count, the larger of the two in the middle. There must be a value. Puts
/// the values into another order.
inline double median_of(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace palpate
