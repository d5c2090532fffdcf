// Where on a part touches may lie that are in no order: the posterior of their placements.
#pragma once

#include <span>

#include "core/part/part_slides.h"

namespace palpate {

/// The posterior of the placement as that of slide_posterior, without a tangent at the reference:
/// its turn is free. The order of the points and their tangents do not count.
///
/// The optima are fitted from pair_starts. From each, its valley is followed to both sides: the
/// reference's foot t is held on a sequence of places, and chi-square minimised over height and
/// turn. A valley ends where chi-square is negligible, or at a barrier, behind which lies another
/// optimum. Directions of travel are +1. core/README.md, "A known closed part".
SlidePosterior touch_posterior(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference);

}  // namespace palpate
