// Noise of a patch from its high frequencies, whatever the class of the curve.
#pragma once

#include <span>
#include <vector>

#include "core/local/local_status.h"

namespace palpate {

struct NoiseEstimate {
  LocalStatus status = LocalStatus::TooFewSamples;
  double sigma_m = 0.0;  ///< standard deviation of one coordinate's white noise [m]
  int dof = 0;           ///< residuals less unknowns; relative sd of sigma_m about 1/sqrt(2 dof)
};

/// Residuals of quartics through blocks of 16 samples, pooled: a median first, then the mean square
/// of what lies within 4 of it, corrected for the cut. sigma_m^2 is unbiased for white Gaussian
/// noise; a tenth of spikes does little harm. Blocks are longer where 16 samples span less than 20
/// sigma (dense or dwelling samples), of 8 where the longer ones show the curve's own bending.
/// Consecutive equal samples count once. Noise that is correlated over more than a block (form
/// error, drift) is not seen. Samples so coarse that 8 of them turn by a right angle have no
/// estimate. Needs 8 distinct samples. Cost O(samples log(samples)) at most.
NoiseEstimate estimate_noise(std::span<const Vec2> samples);

/// Standard deviation of residuals of equal variance by their sizes, some of which are spikes': a
/// median, then the mean square of what lies within 4 of it, corrected for the cut. Reorders them.
double robust_sigma(std::vector<double>& sizes);

}  // namespace palpate
