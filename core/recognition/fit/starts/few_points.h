// Chooses a few of many points, so that a search through them takes bounded time.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Where points are many, so many show every valley of a class: more than ten for each of a
/// spline's six unknowns.
inline constexpr std::size_t kMostSearchedPoints = 64;

/// About kMostSearchedPoints of the points if there are more than twice as many: patches that lie
/// far apart, each with points from end to end, in their order. A class has no larger chi-square on
/// them than on all points: what does not fit these does not fit all. nullopt if there are fewer
/// points. O(patches + points).
std::optional<FitData> few_of(const FitData& reduced);

/// The points of few_of(), which must exist, plus as many other points with the largest `squares`
/// (squared residuals, one per point).
FitData few_and_worst_fitted(const FitData& reduced, std::span<const double> squares);

}  // namespace palpate
