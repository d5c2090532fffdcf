// "Unclassified": a smooth free-form path, a model with its own evidence.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// The result of free-form paths through the reduced points, averaged over their prior.
struct FreeForm {
  /// Chi-square of the paths, in addition to the smooth model's; divided by `inflation`.
  double chi2 = 0.0;
  /// log of what the prior leaves of the likelihood: posterior over prior volume.
  double log_occam = 0.0;
  double determined = 0.0;  ///< number of coordinates that the data determine
};

/// Noise variances are multiplied by `inflation`. O(reduced points).
FreeForm free_form(const SmoothModel& smooth, double inflation, WorkBudget& work);

}  // namespace palpate
