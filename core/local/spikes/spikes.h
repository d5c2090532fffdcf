// Spikes: single samples off the curve by more than noise explains, whatever the class.
#pragma once

#include <span>
#include <vector>

#include "core/local/local_status.h"
#include "core/numerics/work_budget.h"

namespace palpate {

struct SpikeOptions {
  /// Noise, one standard deviation of a coordinate; 0 = by the patch itself. [m]
  double sigma_m = 0.0;
  /// Probability that a patch of white Gaussian noise loses any sample. A sample is a spike where
  /// |residual| > z * its standard deviation, z the two-sided normal quantile of this rate over
  /// the number of samples: 3.9 for 111 samples.
  double false_alarms_per_patch = 0.01;
  /// Steps 2 and 3 are counted in it, and are made as far as it goes: what a block has not been
  /// asked about is no spike. nullptr: as far as they lead.
  WorkBudget* work = nullptr;
};

struct Spikes {
  LocalStatus status = LocalStatus::TooFewSamples;  ///< Ok, or why no noise could be estimated
  std::vector<std::size_t> indices;                 ///< rising
  double sigma_m = 0.0;                             ///< noise used [m]
  double threshold = 0.0;                           ///< z, in standard deviations
};

/// Tests each sample against a quartic (a cubic where spikes are many) through those of the block
/// around it that are no spikes. Three
/// steps, each only where the one before asks for it:
/// 1. Least squares in all blocks of 16 (longer where 16 samples span less than 20 sigma), which
///    overlap by half. Nothing beyond the threshold, nothing behind an earlier sample and the noise
///    not suspicious: no spikes (block_survey.h). O(samples), and all that a clean patch costs.
/// 2. In blocks that overlap by three quarters, a start that spikes in up to half of the block
///    cannot bend (least_median_parabola.h).
/// 3. From it the quartic's own inliers, and the test (spike_search.h): the deletion residual
///    against z, for those within the fit and those outside alike. 1 to 3 are repeated without the
///    spikes found.
/// A corner, a step or a bend is form and no spike: a block does not judge what goes on beyond its
/// own inliers, and blocks that turn by more than 45 degrees judge nothing. Samples that are not
/// finite are spikes; so is a patch's last (first) sample alone beyond a gap of a quarter of its
/// block. Needs 8 finite samples.
Spikes find_spikes(std::span<const Vec2> samples, const SpikeOptions& options = {});

}  // namespace palpate
