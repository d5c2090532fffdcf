// Chooses a few points that show where all points lie.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

struct Spread {
  std::vector<std::size_t> chosen;   ///< indices, in the order of choice
  std::vector<std::size_t> nearest;  ///< for every point, which element of `chosen` is nearest
  double apart = 0.0;  ///< smallest distance between chosen points; infinite for one point
};

/// Chooses the first point, then each time the point farthest from those chosen, until there are
/// `most` or none is farther than `least` away. O(most * points).
Spread spread_widest(std::span<const Vec2> points, std::size_t most, double least);

/// Indices of `most` points (or all): the first point, then each time the point farthest from those
/// chosen. O(most * points).
std::vector<std::size_t> farthest_first(std::span<const Vec2> points, std::size_t most);

}  // namespace palpate
