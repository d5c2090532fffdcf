#include "core/recognition/samples/tips/bend_to_one_side.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpate {

bool may_bend_to_one_side(const FitData& touches, std::span<const double> bends) {
  struct Stroke {
    PatchSpan points;
    double sense;  ///< of its travel, bending left
    double direction;
  };
  std::vector<Stroke> around;
  for (std::size_t p = 0; p < touches.patches.size(); ++p) {
    const PatchSpan& patch = touches.patches[p];
    if (patch.size() > 0) {
      const double sense = bends[p] < 0.0 ? -1.0 : 1.0;
      const Vec2 along = sense * touches.points[patch.begin + patch.size() / 2].tangent;
      around.push_back({patch, sense, std::atan2(along.y(), along.x())});
    }
  }
  std::sort(around.begin(), around.end(),
            [](const Stroke& a, const Stroke& b) { return a.direction < b.direction; });
  const auto has_inside = [&](const Stroke& stroke, const Stroke& other) {
    for (const std::size_t end : {stroke.points.begin, stroke.points.end - 1}) {
      const FitPoint& from = touches.points[end];
      const Vec2 inside = stroke.sense * left_of(from.tangent);
      for (const std::size_t i : {other.points.begin, other.points.end - 1}) {
        if (inside.dot(touches.points[i].position - from.position) < 0.0) {
          return false;
        }
      }
    }
    return true;
  };
  for (std::size_t k = 0; k < around.size(); ++k) {
    const Stroke& next = around[(k + 1) % around.size()];
    if (!has_inside(around[k], next) || !has_inside(next, around[k])) {
      return false;
    }
  }
  return true;
}

}  // namespace palpate
