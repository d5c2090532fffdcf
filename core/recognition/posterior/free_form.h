// "Unclassified": a smooth free-form path, a model with its own evidence.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// The result of free-form paths through the reduced points, averaged over their prior.
struct FreeForm {
  /// Chi-square of the paths, in addition to the smooth model's; divided by `inflation`.
  double chi2 = 0.0;
  /// log of what the prior leaves of the likelihood: posterior over prior volume.
  double log_occam = 0.0;
  double determined = 0.0;  ///< number of coordinates that the data determine
  /// In place of these: log of the integral over an unknown noise, as Likelihood::log_evidence has
  /// it. log_occam then holds what is left to add.
  std::optional<double> log_over_noise = {};
  double noise = 1.0;  ///< the likeliest then, in units of that of the points
};

/// Noise variances are multiplied by `inflation`. O(reduced points).
FreeForm free_form(const SmoothModel& smooth, double inflation, WorkBudget& work);

/// The same where nobody states the noise and the sections hardly show it: what a path through all
/// points leaves is not the noise, and how much is only the prior of paths tells. By quadrature
/// over the noise, from the finest to one as large as the part. O(reduced points), a hundred times
/// as much as free_form.
FreeForm free_form_over_noise(const SmoothModel& smooth, const Likelihood& likelihood,
                              WorkBudget& work);

/// That of the same points with so many times the noise. `samples`: Likelihood::samples.
FreeForm over_times_the_noise(FreeForm paths, double times, double samples);

}  // namespace palpate
