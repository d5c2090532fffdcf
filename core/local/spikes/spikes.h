// Spikes: single samples that lie farther from the curve than noise explains, whatever its class.
#pragma once

#include <span>
#include <vector>

#include "core/local/local_status.h"
#include "core/local/spikes/block_survey.h"
#include "core/numerics/work_budget.h"

namespace palpate {

struct SpikeOptions {
  /// Noise of a coordinate, one standard deviation; 0 = estimate it from the patch. [m]
  double sigma_m = 0.0;
  /// By sample, in units of sigma_m, given or estimated. Empty: 1.
  std::span<const RelativeNoise> noise = {};
  /// Probability that a patch with white Gaussian noise loses any sample. A sample is a spike if
  /// |residual| > z * its standard deviation, where z is the two-sided normal quantile of this
  /// probability divided by the number of samples: 3.9 for 111 samples.
  double false_alarms_per_patch = 0.01;
  CuspEnds cusps = {};
  /// All steps are counted in it. Steps 2 and 3 are made as far as it goes: what a block has not
  /// been asked about is no spike. nullptr: as far as they lead.
  WorkBudget* work = nullptr;
};

struct Spikes {
  LocalStatus status = LocalStatus::TooFewSamples;  ///< Ok, or why the noise could not be estimated
  std::vector<std::size_t> indices;                 ///< of the spikes, in increasing order
  double sigma_m = 0.0;                             ///< noise used [m]
  double threshold = 0.0;                           ///< z, as defined above
};

/// Tests each sample against a quartic (a cubic if there are many spikes) through the samples of
/// its block that are not spikes. Samples that one long step leads to and another leads back from
/// (jumps.h) are no part of a fit at its start, and join like others. Three steps, each only if the
/// one before finds something unusual:
/// 1. Least squares in blocks of 16 (longer if 16 samples span less than 20 sigma) that overlap by
///    half. If nothing exceeds the threshold, no sample lies behind an earlier one and the noise is
///    not suspicious, there are no spikes (block_survey.h). O(samples); a clean patch costs no more
///    than this.
/// 2. In blocks that overlap by three quarters: the quartic through the samples on the path; if
///    more than an eighth of the block would leave it, one through the half that lies nearest to a
///    parabola, which spikes in up to half of the block cannot bend (least_median_parabola.h).
/// 3. The test of the deletion residual against z (spike_search.h), for samples inside and outside
///    that fit. Steps 1 to 3 are repeated without the spikes found.
/// Last, the first and last samples of what is left are tested by longer blocks (spikes_at_ends.h).
///
/// A corner, a step or a bend is form and not a spike: a block does not judge samples beyond its
/// own inliers, and a block that turns by more than 45 degrees judges nothing. Samples that are not
/// finite are spikes. So is the first or last sample of a patch if a gap of a quarter of its block
/// separates it from the rest. Needs 8 finite samples.
Spikes find_spikes(std::span<const Vec2> samples, const SpikeOptions& options = {});

}  // namespace palpate
