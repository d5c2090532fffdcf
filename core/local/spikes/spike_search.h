// The search for spikes in a patch that may have some: a start that they cannot bend, then a sharp
// test.
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

/// Fits a quartic in each of the blocks, which overlap by three quarters (a cubic if more than a
/// quarter of the block is removed). Samples within the threshold join the fit and others leave it
/// until nothing changes. The fit starts from the samples whose `on_path` is set (empty: all); if
/// more than an eighth would leave, it starts from the half that lies nearest to a common parabola.
///
/// A block makes no decision if at most half of its samples join or if it turns by more than 45
/// degrees. A block does not decide on samples beyond the ends of its fit: these may be a bend or a
/// step. Each sample is judged by the block that removes fewest samples. If the noise is not known,
/// it is estimated from the residuals of the samples that joined. Only blocks with a doubtful
/// sample are fitted (BlockSurvey).
SpikeSearch search_spikes(const SearchedSamples& samples, const BlockSurvey& survey,
                          bool noise_is_known, double threshold, const CuspEnds& cusps,
                          WorkBudget& work);

}  // namespace palpate
