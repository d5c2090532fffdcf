// Cuts a patch where it turns, into sections that are graphs over their chords.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Fewest points of a section that shows noise: with fewer, a parabola leaves less than three
/// residuals.
inline constexpr std::size_t kFewestOfSection = 6;

/// Sections of one patch, each turning by less than about a radian. The turn is that of chords
/// between means of a few points. Chords shorter than the noise of the means are not used: noise
/// would turn them any way and cut a patch that does not bend. They are the same whichever way the
/// patch is travelled. `sigma_known`: the noise of the points is stated. O(points).
std::vector<PatchSpan> sections_of(const FitData& data, const PatchSpan& patch, bool sigma_known);

/// The cut half way between two cuts before points a and b. A point in the middle stays with the
/// nearer of its neighbours, whichever way the path is travelled.
std::size_t half_way(const FitData& data, std::size_t a, std::size_t b);

}  // namespace palpate
