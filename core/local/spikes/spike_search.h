// The search for spikes in a patch that has any: a start that they cannot bend, then a sharp test.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/local/spikes/block_survey.h"
#include "core/numerics/work_budget.h"

namespace palpate {

struct SpikeSearch {
  std::vector<std::uint8_t> is_spike;  ///< one flag per sample
  double sigma_m = 0.0;                ///< noise used [m]
};

/// In blocks that overlap by three quarters: a quartic (a cubic where more than a quarter is lost)
/// that samples within the threshold join and others leave until none does either, first from all
/// samples, and where more than an eighth would leave, from the half nearest to a common parabola.
/// A block in which no more than half join, or which turns by more than 45 degrees, says nothing.
/// No block condemns what goes on beyond its own samples, a bend or a step; each sample is judged
/// by the block that loses least. `sigma_m`: 0 = by the residuals of samples that joined. Blocks
/// that `work` does not go to say nothing.
SpikeSearch search_spikes(std::span<const Vec2> samples, const BlockSurvey& survey, double sigma_m,
                          double threshold, WorkBudget& work);

}  // namespace palpate
