// Spikes: single samples off the curve by more than noise explains, whatever the class.
#pragma once

#include <span>
#include <vector>

#include "core/local/local_status.h"

namespace palpate {

struct SpikeOptions {
  /// Noise, one standard deviation of a coordinate; 0 = estimate_noise of the patch. [m]
  double sigma_m = 0.0;
  /// Probability that a patch of white Gaussian noise loses any sample. A sample is a spike where
  /// |residual| > z * its standard deviation, z the two-sided normal quantile of this rate over
  /// the number of samples: 3.9 for 111 samples.
  double false_alarms_per_patch = 0.01;
};

struct Spikes {
  LocalStatus status = LocalStatus::TooFewSamples;  ///< Ok, or why no noise could be estimated
  std::vector<std::size_t> indices;                 ///< rising
  double sigma_m = 0.0;                             ///< noise used [m]
  double threshold = 0.0;                           ///< z, in standard deviations
};

/// Tests each sample against a quartic through the 15 around it (blocks of 16 that overlap by half,
/// longer where 16 samples span less than 20 sigma; the worst leaves, the fit is made again, until
/// none is beyond the threshold). Blocks that turn by
/// more than 45 degrees from their axis or would lose more than a quarter are left as they are: a
/// corner or a step is form, not a spike. Samples that are not finite are spikes. Cost O(samples).
Spikes find_spikes(std::span<const Vec2> samples, const SpikeOptions& options = {});

}  // namespace palpate
