// Dwells: the probe stands still, and its samples repeat one place.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The stretches of a stroke, in order, in which the probe stood still: it moved much less than at
/// its mean speed, and its steps show no order. Such samples must be merged because the fits would
/// take their scatter for travel. At least 16 samples each. A jitter that neighbours share is no
/// larger than the noise, if that is stated (by the samples or `default_sigma_m` [m]). O(samples).
std::vector<PatchSpan> dwells_of(std::span<const StoredSample> samples,
                                 double default_sigma_m = 0.0);

/// The stretches of a stroke, in order, in which samples repeat the one before to a hundredth of
/// the mean step. This happens if a probe is read more often than it moves. O(samples).
std::vector<PatchSpan> repeats_of(std::span<const StoredSample> samples);

/// True if a patch of at least 4 samples is all one place, a touch that was held. If the noise is
/// stated (by the samples or `default_sigma_m` [m]): the samples spread no more than the noise. In
/// any case: they show no order and lie within a hundredth of `half_extent_m` [m], the half extent
/// of all patches.
bool is_one_place(std::span<const StoredSample> samples, double default_sigma_m,
                  double half_extent_m);

/// Replaces each dwell by one sample, the mean. Its weight depends on the noise. If the samples
/// scatter as the stated noise and independently, it weighs as all of them. If they repeat the same
/// error, or the noise is not stated, it weighs as one.
StoredPatch with_means(const StoredPatch& patch, std::span<const PatchSpan> dwells,
                       double default_sigma_m);

/// Replaces the repeats, then the dwells, by their means. Of a stroke that is held at each of its
/// places, for at least 8 samples, with long steps between them: each place by its mean.
StoredPatch without_dwells(const StoredPatch& patch, double default_sigma_m);
std::vector<Vec2> without_dwells(std::span<const Vec2> positions_m);

}  // namespace palpate
