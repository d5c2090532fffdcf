#include "core/recognition/fit/starts/few_points.h"

#include <algorithm>
#include <vector>

#include "core/recognition/fit/starts/farthest_first.h"

namespace palpate {
namespace {

/// One flag a point.
std::vector<bool> chosen_few(const FitData& reduced) {
  // Of a patch: place, direction, curvature and its change are all that a class may be told by at
  // one place.
  constexpr std::size_t kFewestOfPatch = 4;
  std::vector<std::size_t> touched;
  std::vector<Vec2> middles;
  for (std::size_t p = 0; p < reduced.patches.size(); ++p) {
    if (const PatchSpan& patch = reduced.patches[p]; patch.size() > 0) {
      touched.push_back(p);
      middles.push_back(reduced.points[patch.begin + patch.size() / 2].position);
    }
  }
  const std::size_t each = std::max(kFewestOfPatch, kMostSearchedPoints / touched.size());
  std::vector<bool> chosen(reduced.points.size(), false);
  std::size_t sum = 0;
  for (const std::size_t k : farthest_first(middles, kMostSearchedPoints)) {
    if (sum >= kMostSearchedPoints) {
      break;
    }
    const PatchSpan& patch = reduced.patches[touched[k]];
    const std::size_t taken = std::min(each, patch.size());
    for (std::size_t j = 0; j < taken; ++j) {
      chosen[patch.begin + (taken > 1 ? j * (patch.size() - 1) / (taken - 1) : 0)] = true;
    }
    sum += taken;
  }
  return chosen;
}

FitData subset(const FitData& reduced, const std::vector<bool>& chosen) {
  FitData few;
  few.frame = reduced.frame;
  few.scale = reduced.scale;
  for (const PatchSpan& patch : reduced.patches) {
    const std::size_t begin = few.points.size();
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      if (chosen[i]) {
        few.points.push_back(reduced.points[i]);
      }
    }
    if (few.points.size() > begin) {
      few.patches.push_back({begin, few.points.size(), patch.is_joined});
    }
  }
  return few;
}

}  // namespace

std::optional<FitData> few_of(const FitData& reduced) {
  return reduced.points.size() > 2 * kMostSearchedPoints
             ? std::optional(subset(reduced, chosen_few(reduced)))
             : std::nullopt;
}

FitData few_and_worst_fitted(const FitData& reduced, std::span<const double> squares) {
  std::vector<bool> chosen = chosen_few(reduced);
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) {
      others.push_back(i);
    }
  }
  const std::size_t more = std::min(kMostSearchedPoints, others.size());
  std::nth_element(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(more), others.end(),
                   [&](std::size_t a, std::size_t b) { return squares[a] > squares[b]; });
  for (std::size_t k = 0; k < more; ++k) {
    chosen[others[k]] = true;
  }
  return subset(reduced, chosen);
}

}  // namespace palpate
