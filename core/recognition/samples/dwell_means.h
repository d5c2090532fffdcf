// Dwells replaced by their means, each worth as many contacts as it shows.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Replaces each dwell by one sample, the mean. Its weight depends on the noise. If the samples
/// scatter as the stated noise and independently, it weighs as all of them. If they repeat the same
/// error, or the noise is not stated, it weighs as one.
StoredPatch with_means(const StoredPatch& patch, std::span<const PatchSpan> dwells,
                       double default_sigma_m);

/// Replaces the repeats, then the dwells, by their means. Of a stroke that is held at each of its
/// places, for at least 8 samples, with long steps between them: each place by its mean. Spikes of
/// dwells stay beside these (dwell_spikes.h); `false_alarm`: 0 = none is sought.
StoredPatch without_dwells(const StoredPatch& patch, double default_sigma_m,
                           double false_alarm = 0.0);
std::vector<Vec2> without_dwells(std::span<const Vec2> positions_m);

/// Replaces the samples of a patch that is all one place by their mean, as without_dwells().
StoredPatch mean_of_place(const StoredPatch& patch, double default_sigma_m, double false_alarm);

}  // namespace palpate
