// What least squares in overlapping blocks says about a patch: its noise, and whether anything in
// it is unusual at all.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/local/local_status.h"
#include "core/local/residual_block.h"
#include "core/numerics/work_budget.h"

namespace palpate {

struct BlockSurvey {
  LocalStatus status = LocalStatus::TooFewSamples;
  std::size_t length = 0;   ///< samples of a block
  double sigma_m = 0.0;     ///< noise: the one given, or that of the blocks' residuals [m]; ...
  bool is_any_off = false;  ///< a sample is off its block's quartic, or behind earlier ones
  bool is_noise_spiked = false;  ///< ... which spikes pass for: sigma_m is then a low start
};

/// Blocks of 16 samples, or twice that and so on where those span less than 20 sigma. `sigma_m`: 0
/// = not known. `threshold`: standard deviations beyond which a sample is off.
/// Counts in `work`.
BlockSurvey survey_blocks(std::span<const Vec2> samples, double sigma_m, double threshold,
                          WorkBudget& work);

/// Residual beyond which a sample is off the block's quartic: noise, or form that no quartic has.
/// [m]
double residual_limit(const ResidualBlock& block, double sigma_m, double threshold);

/// Whether a sample in use lies farther behind an earlier one than noise takes it.
bool turns_back(const ResidualBlock& block, double sigma_m);

/// A patch's first or last sample in use is alone where it is this part of the block's extent away
/// from the next: the quartic bends to it wherever it is, so that no residual tells. (Fifteen
/// samples evenly apart predict the place of one so far beyond with 15 times their own noise.)
inline constexpr double kLonelyGap = 0.25;

/// function(start) for blocks of `length` samples, `stride` from one to the next; the last one ends
/// with the patch.
template <typename Function>
void for_each_block(std::size_t samples, std::size_t length, std::size_t stride,
                    const Function& function) {
  for (std::size_t first = 0;; first += stride) {
    const std::size_t start = std::min(first, samples - length);
    function(start);
    if (start + length == samples) {
      break;
    }
  }
}

}  // namespace palpate
