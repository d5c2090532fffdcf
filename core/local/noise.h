// Noise of a patch, from its high frequencies. Does not need the class of the curve.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/local/local_status.h"
#include "core/local/residual_block.h"

namespace palpate {

struct NoiseEstimate {
  LocalStatus status = LocalStatus::TooFewSamples;
  double sigma_m = 0.0;  ///< standard deviation of one coordinate's white noise [m]
  /// Residuals minus unknowns; the relative standard deviation of sigma_m is about 1/sqrt(2 dof).
  int dof = 0;
};

/// Estimates the noise from the residuals of quartics through blocks of 16 samples: first a median,
/// then the mean square of the residuals within 4 deviations of it, corrected for that cut. Needs 8
/// distinct samples. O(samples log(samples)) at most.
///
/// For white Gaussian noise sigma_m^2 is unbiased. A tenth of spikes does little harm. Blocks are
/// longer where 16 samples span less than 20 sigma, as residuals and second differences tell it
/// (dense samples, or a probe at rest), and 8 samples long where longer ones show the bending of
/// the curve. Consecutive equal samples count once. Noise that is correlated over more than a block
/// (form error, drift) is not included. If samples are so far apart that 8 of them turn by a right
/// angle, there is no estimate.
NoiseEstimate estimate_noise(std::span<const Vec2> samples);

/// Memory of an estimate, which allocates nothing where it is reserved for as many samples.
struct NoiseScratch {
  void reserve(std::size_t samples) {
    distinct.reserve(samples);
    sizes.reserve(2 * samples);  // second differences of both coordinates
    residuals.reserve(samples);
  }

  std::vector<Vec2> distinct;
  std::vector<double> sizes;
  ResidualBlock residuals;
};
NoiseEstimate estimate_noise(std::span<const Vec2> samples, NoiseScratch* scratch);

/// Standard deviation of residuals of equal variance from their absolute values, some of which may
/// be spikes: a median, then the mean square of those within 4 deviations, corrected for that cut.
/// Reorders `sizes`.
double robust_sigma(std::vector<double>& sizes);

}  // namespace palpate
