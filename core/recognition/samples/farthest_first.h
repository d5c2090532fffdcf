// Points chosen so that few of them show where all lie.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// Indices of `most` of the points, or all: the first one, then each the farthest from those before
/// it. O(most * points).
std::vector<std::size_t> farthest_first(std::span<const Vec2> points, std::size_t most);

}  // namespace palpate
