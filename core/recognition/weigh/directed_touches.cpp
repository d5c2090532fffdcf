#include "core/recognition/weigh/directed_touches.h"

#include <algorithm>

#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {

bool are_strokes(const FitData& touches) {
  return std::all_of(touches.patches.begin(), touches.patches.end(),
                     [](const PatchSpan& patch) { return patch.size() != 1; });
}

DirectedTouches directed_touches(std::span<const StoredPatch> patches, const SideContext& by,
                                 CurveOfCentres* centres) {
  const SmoothModel& smooth = by.arcs.smooth;
  WorkBudget& work = by.work;
  DirectedTouches result{smooth.reduced, {}, {}, false};
  if (by.edges != nullptr && has_tips(result.touches.points) && are_strokes(result.touches) &&
      fits_well(by.edges->chi2, residual_count(by.arcs.data))) {
    result.bends = tell_directions(by.edges->corner, smooth, &result.touches, work);
    result.senses = result.bends;
    result.told = true;
    return result;
  }
  const bool untold = has_untold_tips(smooth);
  const bool asked = untold || has_uncertain_bends(smooth, known_sides(patches, smooth.reduced));
  if (asked && work.allows()) {
    if (const auto& curve = centres->get()) {
      set_directions(DirectionsOf::UntoldPoints, *curve, Feet::Nearest, smooth, &result.touches,
                     work);
      if (work.allows()) {
        result.bends = bends_of(*curve, result.touches, work);
      }
      if (untold && work.allows()) {
        result.senses = senses_of(*curve, result.touches, work);
      }
    }
  }
  if (result.bends.empty()) {
    result.bends = turns_of(result.touches);
  }
  auto bend = result.bends.begin();
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    if (!patch.direction.isZero()) {
      *bend = patch.turn;
    }
    ++bend;
  }
  return result;
}

}  // namespace palpate
