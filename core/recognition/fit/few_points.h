// So few of many points that a search through them takes bounded time.
#pragma once

#include <optional>
#include <span>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// About 64 of the points, where they are more than twice as many: patches that lie far apart, each
/// with points from end to end, in their order. A class leaves no more chi-square on them than on
/// all: what misfits them misfits all. nullopt where there are no more. O(patches + points).
std::optional<FitData> few_of(const FitData& reduced);

/// Those, which there have to be, and as many more that have the largest of `squares`, one a point.
FitData few_and_missed(const FitData& reduced, std::span<const double> squares);

}  // namespace palpate
