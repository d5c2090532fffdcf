// Single touches that repeat one place.
#pragma once

#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The patches, with single touches of one place replaced by their mean, which weighs as all of
/// them: a place touched again tells where it is, and nothing more of the curve. Touches are of one
/// place where they hang together (chained_touches.h), no other touch of their kind lies as near,
/// and they scatter no more than their noise. So touches that lie densely along a curve stay as
/// they are: where some of them were taken together for being close, what noise moved to one side
/// of the curve would get a mean of its own. The mean stands where the first of them was.
std::vector<StoredPatch> without_repeated_touches(std::vector<StoredPatch> patches,
                                                  double default_sigma_m);

}  // namespace palpate
