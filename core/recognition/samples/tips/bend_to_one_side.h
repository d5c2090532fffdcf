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

/// The sides to which strokes bend, > 0 for left, if one curve that bends to one side has them all.
/// Those that bend beyond doubt as they show, the others to where the surface of those lies:
/// centres of tips of different radii are on no curve that could tell. As `bends` where nothing
/// tells, and of single touches.
std::vector<double> bends_to_inside(const FitData& touches, std::vector<double> bends);

}  // namespace palpate
