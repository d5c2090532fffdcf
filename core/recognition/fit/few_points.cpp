#include "core/recognition/fit/few_points.h"

#include <algorithm>
#include <vector>

#include "core/recognition/samples/farthest_first.h"

namespace palpate {

std::optional<FitData> few_of(const FitData& reduced) {
  // Ten for each of a spline's six unknowns.
  constexpr std::size_t kFew = 64;
  // Of a patch: place, direction, curvature and its change are all that a class may be told by at
  // one place.
  constexpr std::size_t kFewestOfPatch = 4;
  if (reduced.points.size() <= 2 * kFew) {
    return std::nullopt;
  }
  std::vector<std::size_t> touched;
  std::vector<Vec2> middles;
  for (std::size_t p = 0; p < reduced.patches.size(); ++p) {
    if (const PatchSpan& patch = reduced.patches[p]; patch.size() > 0) {
      touched.push_back(p);
      middles.push_back(reduced.points[patch.begin + patch.size() / 2].position);
    }
  }
  const std::size_t each = std::max(kFewestOfPatch, kFew / touched.size());
  std::vector<std::size_t> taken(reduced.patches.size(), 0);
  std::size_t sum = 0;
  for (const std::size_t k : farthest_first(middles, kFew)) {
    if (sum >= kFew) {
      break;
    }
    const std::size_t p = touched[k];
    sum += taken[p] = std::min(each, reduced.patches[p].size());
  }
  FitData few;
  few.frame = reduced.frame;
  few.scale = reduced.scale;
  for (std::size_t p = 0; p < taken.size(); ++p) {
    if (taken[p] == 0) {
      continue;
    }
    const PatchSpan& patch = reduced.patches[p];
    const std::size_t begin = few.points.size();
    for (std::size_t j = 0; j < taken[p]; ++j) {
      const std::size_t k = taken[p] > 1 ? j * (patch.size() - 1) / (taken[p] - 1) : 0;
      few.points.push_back(reduced.points[patch.begin + k]);
    }
    few.patches.push_back({begin, few.points.size()});
  }
  return few;
}

}  // namespace palpate
