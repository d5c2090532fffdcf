// Spikes among the first and last samples of a patch.
#pragma once

#include <cstddef>

#include "core/local/spikes/block_survey.h"
#include "core/numerics/work_budget.h"

namespace palpate {

/// How many samples at each end of a patch are spikes.
struct SpikesAtEnds {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// A quartic through a short block bends to a spike at the block's end: of 10 deviations it leaves
/// four in 16 samples. Where the patch goes on, other blocks have a sample in their middle. Its
/// first and last samples are here compared with what the others of a block tell of them, eight,
/// four or two times as long as `length_of_blocks`: by a polynomial two degrees above the parabola
/// or quartic that follows these as noise lets it. Where neither does, or more than
/// kLongestRunOfSpikes in a row are off it, that is form. `threshold`: of the prediction's
/// residual, in standard deviations. Ends next to a cusp are not judged.
SpikesAtEnds find_spikes_at_ends(const SearchedSamples& samples, std::size_t length_of_blocks,
                                 double sigma_m, double threshold, const CuspEnds& cusps,
                                 WorkBudget& work);

}  // namespace palpate
