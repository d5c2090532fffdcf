// Points chosen so that few of them show where all lie.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

struct Spread {
  std::vector<std::size_t> chosen;   ///< indices, in the order of choice
  std::vector<std::size_t> nearest;  ///< of every point: which of `chosen` is the nearest
  double apart = 0.0;                ///< no two of the chosen are closer; infinite of one
};

/// The first of the points, then each the farthest from those before it, until there are `most` or
/// none lies farther than `least` away. O(most * points).
Spread spread_widest(std::span<const Vec2> points, std::size_t most, double least);

/// Indices of `most` of the points, or all: the first one, then each the farthest from those before
/// it. O(most * points).
std::vector<std::size_t> farthest_first(std::span<const Vec2> points, std::size_t most);

}  // namespace palpate
