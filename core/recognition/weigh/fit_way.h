// One way in which the tips may lie, fitted along the directions that the curve found has.
#pragma once

#include <span>

#include "core/recognition/weigh/curve_of_centres.h"
#include "core/recognition/weigh/side_choice.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

/// The way with the tips on these sides, judged.
SideChoice fit_way(const FitData& touches, std::span<const int> sides, const SideContext& by,
                   std::span<const SidedStart> starts, const CurveOfCentres& centres);

/// The same way, tried once more where its directions led to no curve that all points have: along
/// those that `touches` have been told since; else along those of the curve of the centres, whose
/// normals are nearly the surface's whichever side that is on, and then with its bend rounded: next
/// to a corner that no touch lies on, the curve of the others' centres is a cusp. What is out on
/// all points beside `highest`, the log evidence of another way that all points have, need not be
/// told better.
SideChoice fit_way_again(SideChoice choice, const FitData& touches, const SideContext& by,
                         double highest, CurveOfCentres* centres);

/// The same way along the normals of `parallel`, a curve of another way that all points have, if it
/// has more evidence so: curves through the same centres have the same normals, and those of a tip
/// on a pin thinner than itself are far off.
SideChoice fit_way_along(const CanonicalFit& parallel, SideChoice choice, const FitData& touches,
                         const SideContext& by, const CurveOfCentres& centres);

}  // namespace palpate
