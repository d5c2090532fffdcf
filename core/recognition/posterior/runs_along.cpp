#include "core/recognition/posterior/runs_along.h"

#include <algorithm>

namespace palpate {

Runs runs_along(const CanonicalFit& placed, std::span<const PatchSpan> patches) {
  Runs runs;
  runs.order.reserve(placed.points.size());
  for (const PatchSpan& patch : patches) {
    if (patch.size() == 1) {
      runs.order.push_back(patch.begin);
    }
  }
  std::sort(runs.order.begin(), runs.order.end(),
            [&](std::size_t a, std::size_t b) { return placed.points[a].t < placed.points[b].t; });
  runs.spans.push_back({0, runs.order.size()});
  for (const PatchSpan& patch : patches) {
    if (patch.size() == 1) {
      continue;
    }
    const std::size_t begin = runs.order.size();
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      runs.order.push_back(i);
    }
    runs.spans.push_back({begin, runs.order.size()});
  }
  return runs;
}

}  // namespace palpate
