// Ends of strokes that are set aside and lead away from the curve.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/counted/weighed.h"

namespace palpate {

/// Whether the last three samples of a patch, at either end, have a flag and lie ever farther off
/// on one side of the curve, or the last four have one and lie on one side: the part leaves the
/// curve there, or the probe leaves the part, whatever took them for spikes. `aside`: one flag per
/// sample of the patches. core/README.md, "A way that is set aside".
bool has_way_set_aside(std::span<const StoredPatch> patches, const std::vector<bool>& aside,
                       const ExplainingCurve& curve);

}  // namespace palpate
