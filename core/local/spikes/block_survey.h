// Least-squares fits in overlapping blocks of a patch. They give the noise, and show whether the
// patch may contain spikes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/local/local_status.h"
#include "core/local/residual_block.h"
#include "core/numerics/work_budget.h"

namespace palpate {

/// Which ends of the samples are next to a cusp of the stroke of which they are a part.
struct CuspEnds {
  bool first = false;
  bool last = false;

  /// Whether a block of them, samples [begin, end) of `count`, has such an end.
  bool touched_by(std::size_t begin, std::size_t end, std::size_t count) const {
    return (first && begin == 0) || (last && end == count);
  }
};

/// The samples among which spikes are sought, in their order on the stroke.
struct SearchedSamples {
  std::span<const Vec2> positions_m;
  std::span<const RelativeNoise> noise = {};  ///< by sample; empty: 1
  /// Which a fit starts from; the others are only compared with it. Empty: all.
  std::span<const std::uint8_t> on_path = {};

  std::size_t size() const { return positions_m.size(); }
  bool is_on_path(std::size_t i) const { return on_path.empty() || on_path[i] != 0; }
  RelativeNoise noise_of(std::size_t i) const { return noise.empty() ? RelativeNoise{} : noise[i]; }

  SearchedSamples part(std::size_t start, std::size_t count) const {
    return {positions_m.subspan(start, count), noise.empty() ? noise : noise.subspan(start, count),
            on_path.empty() ? on_path : on_path.subspan(start, count)};
  }
};

struct BlockSurvey {
  LocalStatus status = LocalStatus::TooFewSamples;
  std::size_t length = 0;   ///< number of samples of a block
  double sigma_m = 0.0;     ///< noise, as given or from the residuals of the blocks [m]
  bool is_any_off = false;  ///< a sample is off the quartic of its block, or behind earlier samples
  /// Spikes may have enlarged the noise; sigma_m is then a deliberately low starting value.
  bool is_noise_spiked = false;
  /// By sample: whether it lies in a block of which one may be off. Empty: spikes may be anywhere.
  std::vector<std::uint8_t> doubtful;
};

/// Fits blocks of 16 samples, or of 32, 64 ... if those span less than 20 sigma. `sigma_m`: 0 =
/// unknown. A sample whose residual exceeds `threshold` standard deviations is off.
BlockSurvey survey_blocks(const SearchedSamples& samples, double sigma_m, double threshold,
                          const CuspEnds& cusps, WorkBudget& work);

/// What form leaves of a block's quartic, counted as noise. [m]
double form_noise_m(const ResidualBlock& block, bool at_cusp);

/// Whether a sample in use lies farther behind an earlier one than noise explains.
bool turns_back(const ResidualBlock& block, double sigma_m);

/// The first or last sample in use of a patch is lonely if its distance to the next is at least
/// this fraction of the block's extent. The quartic bends to such a sample wherever it is, so its
/// residual shows nothing. (Fifteen evenly spaced samples predict the place of one so far beyond
/// with 15 times their own noise.)
inline constexpr double kLonelyGap = 0.25;

/// Calls function(start) for blocks of `length` samples that start `stride` samples apart. The last
/// block ends with the patch.
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
