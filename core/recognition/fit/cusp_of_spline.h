// A spline on all points, and what it is next to: each may start from the other.
#pragma once

#include <optional>

#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// The optimum of the semi-cubical parabola (a spline of c = 0) on all points, from that of a
/// spline: its vertex becomes the cusp, every point keeps its place. A spline that is one to within
/// the noise leads there even where feet or reduced points about the cusp do not. nullopt if that
/// is no curve that was touched so. O(points) per iteration.
std::optional<ClassFit> cusp_of_spline(const ClassFit& spline, const FitData& data,
                                       WorkBudget& work);

/// The spline's optimum on all points from that of a class that it is at one of its limits: a
/// parabola or another cubic. nullopt if that is no curve that was touched so. O(points) per
/// iteration.
std::optional<ClassFit> spline_from_limit(const ClassFit& limit, const FitData& data,
                                          WorkBudget& work);

/// A fit on all points as one on the reduced points, not refined there. O(reduced points).
ClassFit placed_on_reduced(const ClassFit& on_all, const FitData& reduced, WorkBudget& work);

}  // namespace palpate
