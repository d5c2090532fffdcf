#include "core/recognition/weigh/directed_touches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {

namespace {

/// How strokes travel along the direction that they have most in common: along a straight edge, or
/// a curve that does not turn back.
std::vector<double> senses_in_common(const FitData& touches) {
  const auto middle_of = [&](std::size_t p) {
    return touches.points[touches.patches[p].begin + touches.patches[p].size() / 2].tangent;
  };
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (std::size_t p = 0; p < touches.patches.size(); ++p) {
    squares += middle_of(p) * middle_of(p).transpose();
  }
  const double angle = 0.5 * std::atan2(2.0 * squares(0, 1), squares(0, 0) - squares(1, 1));
  const Vec2 common(std::cos(angle), std::sin(angle));
  std::vector<double> senses;
  for (std::size_t p = 0; p < touches.patches.size(); ++p) {
    senses.push_back(common.dot(middle_of(p)));
  }
  return senses;
}

}  // namespace

bool have_other_radii(const FitData& touches) {
  return std::any_of(touches.points.begin(), touches.points.end(), [&](const FitPoint& point) {
    return point.offset != touches.points.front().offset;
  });
}

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
  if (have_other_radii(result.touches) && are_strokes(result.touches)) {
    result.senses = senses_in_common(result.touches);
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
