// Spikes while a probe stands still.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Moves the spikes of each dwell out of it: to its end, or before it where the dwell ends the
/// patch, and marks them (StoredSample::is_off_dwell). A mean of all would be off by a share of
/// them. `false_alarm`: probability that a dwell without spikes loses any sample. O(samples log
/// samples).
void set_spikes_apart(double default_sigma_m, double false_alarm, StoredPatch* patch,
                      std::vector<PatchSpan>* dwells);

}  // namespace palpate
