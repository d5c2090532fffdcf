// Single touches that repeat one place.
#pragma once

#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Replaces single touches of one place by their mean, which weighs as all of them: a place touched
/// again tells where it is, and nothing more of the curve. Touches are of one place where they hang
/// together (chained_touches.h), no other touch of their kind lies as near, and they scatter no
/// more than their noise. So touches that lie densely along a curve stay as they are: where some of
/// them were taken together for being close, what noise moved to one side of the curve would get a
/// mean of its own. The mean stands where the first of them was.
///
/// `clean`: the same patches without spikes. A single sample that the search for spikes left of a
/// stroke is no touch. Both lists keep the same patches, in the same order.
void merge_repeated_touches(double default_sigma_m, std::vector<StoredPatch>* moved,
                            std::vector<StoredPatch>* clean);

}  // namespace palpate
