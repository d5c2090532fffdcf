// Spikes among stored samples.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// Four samples in a row off a curve are a bend. At a rate of one in 20 chance has so many in a row
/// once in 20^4 samples, more than the memory holds.
inline constexpr std::size_t kLongestRunOfSpikes = 3;

/// find_spikes (core/local/spikes/spikes.h) on the positions of one patch, noise by the patch
/// itself: one flag per sample. `false_alarm`: probability that a patch without spikes loses any
/// sample. As far as `work` goes.
std::vector<bool> spikes_of(std::span<const StoredSample> samples, double false_alarm,
                            WorkBudget& work);

/// The samples that are no spikes; one flag each.
std::vector<StoredSample> without_spikes(std::span<const StoredSample> samples,
                                         const std::vector<bool>& is_spike);

/// The patch with these samples alone, and what is known of them.
StoredPatch without_spikes(const StoredPatch& patch, const std::vector<bool>& is_spike);

}  // namespace palpate
