// Quantiles of a set of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace palpate {

/// The number of this rank, 0 the smallest. There must be more numbers than `rank`. Puts them into
/// another order.
inline double ranked(std::span<double> values, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The number that a `fraction` (below 1) of all are smaller than, likewise.
inline double quantile_of(std::span<double> values, double fraction) {
  return ranked(values, static_cast<std::size_t>(fraction * static_cast<double>(values.size())));
}

/// The median; of an even count, the larger of the two in the middle, likewise.
inline double median_of(std::span<double> values) { return ranked(values, values.size() / 2); }

}  // namespace palpate
