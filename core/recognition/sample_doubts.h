// What the samples themselves let an answer say, whatever class is found.
#pragma once

#include <cstddef>
#include <span>

#include "core/recognition/recognition.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Whether there can be an answer: enough places were touched (fewest_places.h), over an extent
/// that double precision resolves. `patches`: how many were stroked or touched.
bool can_answer(const FitData& data, std::size_t patches);

/// Doubts that no class takes away: the noise is only a guess, no path leads through what is sent
/// as strokes, or a class may fit so few places by chance. `data`: of `patches`, or of touches
/// among them that are joined. `by_evidence`: classes were compared, not told by the paper's tree.
Recognition with_sample_doubts(Recognition answer, const FitData& data,
                               std::span<const StoredPatch> patches, bool by_evidence);

}  // namespace palpate
