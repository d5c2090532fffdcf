// Where in a class's prior a mode of its posterior is sought.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/modes/touched_curve.h"

namespace palpate {

/// A curve of the class that is not on the points yet.
struct PriorStart {
  Touch touch;
  TouchedCurve curve;  ///< z, shape and feet
};

/// Shapes of the prior that bend like `fitted` where it was touched: as large as its curvature
/// says, with about the rate of the curvature. One on each arm, side and sense of travel that the
/// class has, the most probable first, four at most. None where `fitted` is straight there. A
/// spline's first is an arc (arc_coordinates.h). `touch`: of the class; its tangent is the path's,
/// either way.
std::vector<PriorStart> prior_starts(const Touch& touch, CurveClass path_class,
                                     const TouchedCurve& fitted);

/// On which arm of its class a curve lies that is touched along the path of `along`: arms that no
/// way joins have numbers of their own, as far as cubics have such.
std::size_t arm_of(const Touch& along, const Touch& touch, const TouchedCurve& mode);

}  // namespace palpate
