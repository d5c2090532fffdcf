// Poses that lay two touches on a part: starts for the placement of touches in no order.
#pragma once

#include <span>
#include <vector>

#include "core/part/part_fit.h"

namespace palpate {

/// Poses data_T_part that lay `reference`, or its tip, on the part at one of 24 places a
/// segment and the touch farthest from it on the part too, for every place and every such way.
///
/// Two touches at a distance d lie on the places t and t' of the part if |C(t') - C(t)| = d. That
/// leaves one dimension of the poses, which the places sample: one of them is at most half their
/// step away from the reference's true place. If the part is too small for
/// that distance, the one pose that comes nearest. Empty if all points lie at one place.
/// O(places * nodes + points).
std::vector<Pose2> pair_starts(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference);

}  // namespace palpate
