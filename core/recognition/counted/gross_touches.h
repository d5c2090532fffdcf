// Single touches that err grossly, found where no class fits all of them.
#pragma once

#include <optional>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// `data` without the fewest touches that no class could have beside the others: with them no class
/// fits, without them one leaves no more than noise. A touch that pulls a fit towards itself shows
/// no residual that would tell it from others, so that each is left out in turn. nullopt if there
/// are none, if there are strokes among the data, or if it takes more than most_set_aside().
std::optional<FitData> without_gross_touches(const Weighing& weighing, const FitData& data,
                                             WorkBudget& work);

/// log odds against gross errors of the single touches of `data` that are not in `kept`.
double log_odds_against_gross(const FitData& data, const FitData& kept);

}  // namespace palpate
