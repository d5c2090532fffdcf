#include "core/recognition/samples/tip_sides.h"

#include <algorithm>
#include <cmath>

namespace palpate {

int stated_side(MaterialSide side) {
  switch (side) {
    case MaterialSide::Left:
      return -1;
    case MaterialSide::Right:
      return 1;
    case MaterialSide::Unspecified:
      break;
  }
  return 0;
}

std::vector<std::vector<int>> possible_sides(std::span<const StoredPatch> patches,
                                             const FitData& reduced, double lone_bend) {
  std::vector<int> known(reduced.patches.size(), 0);
  std::vector<int> outside_of_bend(reduced.patches.size(), 0);
  bool any_unknown = false;
  std::size_t p = 0;
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    if (patch.context.tip_radius_m > 0.0) {
      const auto points = reduced.patch(p);
      // A path that bends left has its tips outside, to the right, if the part is convex there.
      const bool lone = points.size() == 1;
      double turn = lone ? lone_bend : 0.0;
      // (summed from point to point: a patch may go all the way round)
      for (std::size_t i = 1; i < points.size(); ++i) {
        turn += std::atan2(cross(points[i - 1].tangent, points[i].tangent),
                           points[i - 1].tangent.dot(points[i].tangent));
      }
      outside_of_bend[p] = turn >= 0.0 ? -1 : 1;
      known[p] = lone ? 0 : stated_side(patch.context.material_side);
      any_unknown = any_unknown || known[p] == 0;
    }
    ++p;
  }
  if (!any_unknown) {
    return {known};
  }
  std::vector<std::vector<int>> ways;
  const auto add = [&](auto side_of) {
    std::vector<int> way(known.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      way[i] = known[i] != 0 || outside_of_bend[i] == 0 ? known[i] : side_of(i);
    }
    if (std::find(ways.begin(), ways.end(), way) == ways.end()) {
      ways.push_back(std::move(way));
    }
  };
  add([&](std::size_t i) { return outside_of_bend[i]; });
  add([&](std::size_t i) { return -outside_of_bend[i]; });
  add([](std::size_t) { return 1; });
  add([](std::size_t) { return -1; });
  return ways;
}

FitData on_surface(const FitData& reduced, std::span<const int> sides) {
  FitData surface = reduced;
  for (std::size_t p = 0; p < surface.patches.size(); ++p) {
    for (std::size_t i = surface.patches[p].begin; i < surface.patches[p].end; ++i) {
      FitPoint& point = surface.points[i];
      point.position -= sides[p] * point.offset * left_of(point.tangent);
      point.offset = 0.0;
    }
  }
  return surface;
}

}  // namespace palpate
