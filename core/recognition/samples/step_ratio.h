// Whether the places of a stroke follow one another.
#pragma once

#include <cstddef>

#include "core/curves/pose2.h"

namespace palpate {

/// J. von Neumann's ratio (1941): mean square step over twice the mean square distance from the
/// mean, `square`. It is 1 for places in random order and 6 / (n^2 - 1) for n places evenly spaced
/// along a line. 1 too if all are in one place.
template <typename PlaceAt>
double step_ratio(const PlaceAt& place_at, std::size_t begin, std::size_t end, double square) {
  double steps = 0.0;
  for (std::size_t i = begin + 1; i < end; ++i) {
    steps += (place_at(i) - place_at(i - 1)).squaredNorm();
  }
  const double n = static_cast<double>(end - begin);
  return square > 0.0 ? steps / (n - 1.0) / (2.0 * square) : 1.0;
}

/// Motion over a length l with noise s gives the ratio 2 s^2 / (2 s^2 + l^2 / 12). This limit is l
/// = 6 s: over such a length a curve deviates from its mean by less than the mean's uncertainty.
inline constexpr double kNoOrder = 0.4;

/// Fewest places that show their order: five evenly spaced ones have the ratio 0.25, four kNoOrder.
inline constexpr std::size_t kFewestInOrder = 5;

}  // namespace palpate
