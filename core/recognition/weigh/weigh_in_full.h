// A weighing that uses all that a probe says of its samples.
#pragma once

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// weigh(), with covariances as they lie across the curve and normals along strokes. Where no point
/// says more than a position and a noise of one size it is weigh(), to the bit.
Weighing weigh_in_full(const FitData& data, std::span<const StoredPatch> patches, WorkBudget& work,
                       const WeighOptions& options = {}, std::span<const SidedStart> starts = {});

}  // namespace palpate
