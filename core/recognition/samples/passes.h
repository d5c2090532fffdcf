// Cuts strokes that turn back over themselves into passes of one direction each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Indices of the samples at which a new pass begins (not the first pass), ascending. A pass has at
/// least 6 samples and leads back over the path of the one before it. A stroke that turns back
/// beside its path (a cusp, the end of a needle), or by no more than the samples' own noise, is not
/// cut. O(samples).
std::vector<std::size_t> returns_of(std::span<const StoredSample> samples);

/// Cuts the patch before each of these samples. Every second pass is reversed, so that all passes
/// have the direction of the first and the material on the same side of travel.
std::vector<StoredPatch> passes_of(const StoredPatch& patch, std::span<const std::size_t> returns);

}  // namespace palpate
