// Where the fit of a given class starts from.
#pragma once

#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"

namespace palpate {

struct GivenStart {
  ShapeParameters shape;
  Pose2 pose;  ///< in the points' frame
};

/// Curves of the class near `points`, in any order, whatever their neighbours; the better ones
/// first. Points of unit extent about the origin.
std::vector<GivenStart> given_starts(CurveClass curve_class, std::span<const Vec2> points);

}  // namespace palpate
