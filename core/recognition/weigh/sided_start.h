// What one weighing keeps for the next one of the same object, for each choice of the tips' sides.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/recognition/fit/warm_start.h"
#include "core/recognition/posterior/kept_modes.h"

namespace palpate {

struct SidedStart {
  std::vector<int> sides;  ///< one per patch (samples/tips/tip_sides.h)
  WarmStart start;
  KeptModes modes = {};
};

/// The start for those sides; nullptr if there is none.
inline const SidedStart* start_for(std::span<const SidedStart> starts, std::span<const int> sides) {
  const auto start = std::find_if(starts.begin(), starts.end(), [&](const SidedStart& s) {
    return std::equal(s.sides.begin(), s.sides.end(), sides.begin(), sides.end());
  });
  return start == starts.end() ? nullptr : &*start;
}

}  // namespace palpate
