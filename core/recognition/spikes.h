// Spikes of a sensor: single samples far off the arc that their neighbours make.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/sample_memory.h"

namespace palpate {

/// One flag per sample of a patch: whether it lies off the arc through its neighbours (a robust
/// local parabola across the direction of travel, least absolute deviations, at least ten
/// neighbours) farther than Gaussian noise of the patch's own robust scale reaches in any sample
/// with probability `false_alarm`. Needs no class, survives spikes in a third of the samples, and
/// takes no bend of a smooth arc for a spike. A patch of fewer than 12 samples has none.
/// O(samples); almost free where the differences show nothing unusual.
std::vector<bool> find_spikes(std::span<const StoredSample> samples, double false_alarm);

/// The same in passes, each without the spikes found before, which hide others. Long runs that the
/// passes have eaten into the patch are a sharp bend, and no spikes.
std::vector<bool> find_spikes_in_passes(std::span<const StoredSample> samples, double false_alarm);

/// The samples that are no spikes; one flag each.
std::vector<StoredSample> without_spikes(std::span<const StoredSample> samples,
                                         const std::vector<bool>& is_spike);

}  // namespace palpate
