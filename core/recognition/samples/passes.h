// Strokes that go back over where they came from, as passes of one direction each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Where a stroke turns back over itself: the first sample of each pass but the first, rising. A
/// pass has 6 samples at least and leads by its own way back to where the one before it came from:
/// what turns back beside it (a cusp, the end of a needle) does not count, nor what turns back no
/// farther than the samples' noise, as they show it. O(samples).
std::vector<std::size_t> returns_of(std::span<const StoredSample> samples);

/// The patch cut before each of these samples, all passes in the direction of the first: those that
/// come back have their samples from the last to the first. So the material lies on the same side
/// of travel of all.
std::vector<StoredPatch> passes_of(const StoredPatch& patch, std::span<const std::size_t> returns);

}  // namespace palpate
