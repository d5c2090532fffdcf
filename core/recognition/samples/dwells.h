// Dwells: a probe stands still, and its samples repeat one place.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The stretches of a stroke, in their order, in which the probe stood still: by its mean speed it
/// would have gone much farther, and what it went shows no order. Scatter about one place has no
/// direction, and would be taken for one. Of at least 16 samples. O(samples).
std::vector<PatchSpan> dwells_of(std::span<const StoredSample> samples);

/// The stretches of a stroke, in their order, in which samples repeat the one before, but for a
/// hundredth of the mean step: of a probe that is read more often than it moves. O(samples).
std::vector<PatchSpan> repeats_of(std::span<const StoredSample> samples);

/// Whether a patch of at least 4 samples is all one place: a touch that was held. Where its noise
/// is stated, by `default_sigma_m` [m] if not by the samples, that is all they spread; where it is
/// not, they show no order and lie within a hundredth of `half_extent_m` [m], that of all patches.
bool is_one_place(std::span<const StoredSample> samples, double default_sigma_m,
                  double half_extent_m);

/// The patch with one sample, their mean, for each dwell. It weighs what its noise lets it: as all
/// of them where they scatter as the noise that is stated and each afresh; as one of them where
/// they repeat the same error, or where nobody states the noise.
StoredPatch with_means(const StoredPatch& patch, std::span<const PatchSpan> dwells,
                       double default_sigma_m);

/// The same for its repeats, then its dwells.
StoredPatch without_dwells(const StoredPatch& patch, double default_sigma_m);
std::vector<Vec2> without_dwells(std::span<const Vec2> positions_m);

}  // namespace palpate
