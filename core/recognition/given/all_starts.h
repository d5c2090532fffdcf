// All curves that the search of a given class starts from.
#pragma once

#include <vector>

#include "core/recognition/given/local_points.h"
#include "core/recognition/given/starts/given_starts.h"

namespace palpate {

/// Starts from the points. If normals are measured, also from two extra places per point, on its
/// tangent to either side: so there are starts for fewer points than the class has unknowns.
std::vector<GivenStart> starts_of(CurveClass curve_class, const LocalPoints& local);

}  // namespace palpate
