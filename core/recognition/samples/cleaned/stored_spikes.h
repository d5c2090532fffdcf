// Spikes among stored samples.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/local/spikes/block_survey.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Beforehand one sample in a hundred errs by far more than its noise: the probe slips, or touches
/// something else.
inline constexpr double kGross = 0.01;

/// How many of `count` measurements a class may set aside. If there are more, the curve is wrong:
/// more frequent spikes were found before any class was known (clean_patches.h). Two may be set
/// aside however few there are: of the fewest places for RECOGNIZED, eight, as many remain as a
/// spline has unknowns.
constexpr std::size_t most_set_aside(std::size_t count) {
  constexpr std::size_t kOneIn = 20;
  constexpr std::size_t kMost = 2;
  return kMost + count / kOneIn;
}

/// Runs find_spikes (core/local/spikes/spikes.h) on the positions of one patch; how large the noise
/// is comes from the patch itself, and only what it is of one sample beside another from its
/// `noise` (relative_noise.h). One flag per sample. `false_alarm`: probability that a patch without
/// spikes loses any sample.
std::vector<bool> spikes_of(std::span<const StoredSample> samples, double false_alarm,
                            WorkBudget& work, const CuspEnds& cusps = {},
                            std::span<const RelativeNoise> noise = {});

/// The same of a patch as its samples state their noise, or else the default (0: not known).
std::vector<bool> spikes_of(const StoredPatch& patch, double default_sigma_m, double false_alarm,
                            WorkBudget& work);

/// The samples without a flag. One flag per sample.
std::vector<StoredSample> without_spikes(std::span<const StoredSample> samples,
                                         const std::vector<bool>& is_spike);

/// The patch with only these samples and their details.
StoredPatch without_spikes(const StoredPatch& patch, const std::vector<bool>& is_spike);

}  // namespace palpate
