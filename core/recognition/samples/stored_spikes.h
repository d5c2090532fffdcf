// Spikes among stored samples.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// find_spikes (core/local/spikes/spikes.h) on the positions of one patch, noise by the patch
/// itself: one flag per sample. `false_alarm`: probability that a patch without spikes loses any
/// sample.
std::vector<bool> spikes_of(std::span<const StoredSample> samples, double false_alarm);

/// The samples that are no spikes; one flag each.
std::vector<StoredSample> without_spikes(std::span<const StoredSample> samples,
                                         const std::vector<bool>& is_spike);

/// The patch with these samples alone, and what is known of them.
StoredPatch without_spikes(const StoredPatch& patch, const std::vector<bool>& is_spike);

}  // namespace palpate
