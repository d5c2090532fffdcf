// Whether strokes may be of one curve that bends to one side.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Whether one curve that bends to one side may have all strokes: around it, by their directions,
/// each has the next and the one before on the side to which it bends, as its ends see them.
/// `bends`: the sides to which the patches of `touches` bend, > 0 for left of their travel.
bool may_bend_to_one_side(const FitData& touches, std::span<const double> bends);

}  // namespace palpate
