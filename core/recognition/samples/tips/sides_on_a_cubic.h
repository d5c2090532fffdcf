// Sides of round tips by which all touched points may lie on one curve of the third order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The ways in which tips may lie (one side per patch, as PossibleSides::ways has them) by which
/// the surface points lie on one curve of the third order as noise lets them; of these the `most`
/// that leave least, in order. Every class is an arc of such a curve, and the curve that fits best
/// takes one eigenvalue where a search of the classes takes its time; but edges, and two curves of
/// lower order, are such curves too.
///
/// `touches`: reduced points of strokes, with their directions. `known`: the side of each patch; 0
/// where it is open. Empty if there are fewer points than tell one such curve from another, or if
/// `work` is spent. O(patches).
std::vector<std::vector<int>> sides_on_a_cubic(const FitData& touches, std::span<const int> known,
                                               std::size_t most, WorkBudget& work);

}  // namespace palpate
