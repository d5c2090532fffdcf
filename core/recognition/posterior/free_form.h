// "Unclassified": a smooth free-form path, as a model with evidence of its own.
#pragma once

#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// What free-form paths of the patches leave of the reduced points, averaged over the prior.
struct FreeForm {
  double chi2 = 0.0;  ///< left by the paths, beside the smooth model's own and inflated likewise
  double log_occam = 0.0;   ///< log of prior over posterior volume
  double determined = 0.0;  ///< coordinates that the data determine
};

/// Noise variances count `inflation` times. O(reduced points).
FreeForm free_form(const SmoothModel& smooth, double inflation);

}  // namespace palpate
