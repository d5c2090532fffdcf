// Which of two semi-cubical parabolas that open opposite ways is the class's.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// Where a search has found two, the one with more evidence; it has no rival any more. An arc of
/// one arm is nearly an arc of another that opens the other way, and there more sheared and larger
/// than is ever expected: noise may make that one fit better, by a little, and leave the class
/// without probability. Noise variances are multiplied by `inflation`. O(points) per iteration.
ClassFits with_probable_cusp(ClassFits fits, const FitData& reduced, double inflation,
                             WorkBudget& work);

}  // namespace palpate
