// Dwells: the probe stands still, and its samples repeat one place (dwell_means.h: what stands for
// them).
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

/// True if a patch of several samples is all one place, a touch that was held. If the noise is
/// stated (by the samples or `default_sigma_m` [m]): the samples spread no more than the noise. In
/// any case: at least kFewestInOrder (step_ratio.h) samples show no order and lie within a
/// hundredth of `half_extent_m` [m], the half extent of all patches; or fewer than twice as many,
/// which noise may put in order, lie within a thousandth.
bool is_one_place(std::span<const StoredSample> samples, double default_sigma_m,
                  double half_extent_m);

/// The places of a stroke that is held at each: long steps lead from one to the next. Empty where
/// it is no such stroke: less than half of its samples are of such places, or one of these shows an
/// order or is no farther from the one before than both scatter.
std::vector<PatchSpan> held_places(std::span<const StoredSample> samples);

}  // namespace palpate
