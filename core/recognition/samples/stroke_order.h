// Whether the samples of strokes follow one another along the part.
#pragma once

#include <span>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Of places that follow one another in one stroke: whether they do so in the plane too. Of places
/// to and fro all over the part, or of no longer a way than their noise, no order is known.
bool show_order(std::span<const Vec2> stroke);

/// Whether it leads to and fro over a part of that extent: touches that someone sends as one
/// stroke. Spikes in a stroke do not make it so, nor noise where it is short.
bool leads_to_and_fro(std::span<const Vec2> stroke, double extent);

/// Whether most samples are of such. No smooth path leads through them, and what it leaves is not
/// their noise.
bool lead_mostly_to_and_fro(std::span<const StoredPatch> patches);

}  // namespace palpate
