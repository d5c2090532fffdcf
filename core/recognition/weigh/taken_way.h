// Which of the ways in which the tips may lie is told, and how surely.
#pragma once

#include "core/recognition/weigh/sided_fits.h"

namespace palpate {

/// Takes the way of the highest evidence, the expected one (from outside the bends) at the odds of
/// the prior, and says by how much it leads.
void take_most_probable(const SideContext& by, SidedFits* sided);

/// Takes the classes of the way that is taken to where each has the tips' centres itself: samples
/// that show no direction, or one that noise sways, have that of the curve which led, and another
/// class may turn otherwise between the others. (Of tips that touch alone every way has it so.)
void take_own_directions(const SideContext& by, SidedFits* sided);

}  // namespace palpate
