// Starting curves for the fit of a given class.
#pragma once

#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"

namespace palpate {

struct GivenStart {
  ShapeParameters shape;
  Pose2 pose;    ///< in the points' frame
  int arm = 0;   ///< all points lie where t has this sign; 0 = not known
  int side = 0;  ///< the tips lie on this side of the curve (+1 left, -1 right); 0 = not known
};

/// Curves of the class near `points`; the better ones come first. The points may be in any order,
/// have unit extent and lie about the origin.
std::vector<GivenStart> given_starts(CurveClass curve_class, std::span<const Vec2> points);

}  // namespace palpate
