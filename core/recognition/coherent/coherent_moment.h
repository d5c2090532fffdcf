// The uncertainty of shape and pose that shared deviations of neighbouring points cause.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct CoherentMoment {
  /// Posterior probability of such deviations; 1/2 a priori.
  double probability = 0.0;
  /// Second moment E[(x - estimate)(x - estimate)^T] of x = [shape; x; y; theta] if there are such
  /// deviations.
  ShapePoseCovariance moment;
  /// Their root mean square at a point, normalised, without the offset's constant, which bends no
  /// path.
  double deviation = 0.0;
};

/// Models residuals as noise, a drift along each patch and an offset by the direction of the
/// normal, all of unknown size (core/README.md, "Deviations that neighbours share"). The visible
/// part of such deviations shows how large the part is that the shape has absorbed. For given sizes
/// the model is linear about `placed`, the class on `reduced`. `sigma`: noise of the typical point,
/// normalised. `scatter`: chi-square of all samples about the reduced points, the same for every
/// class. The result is in metres and radians, world frame. nullopt if there are too few points for
/// a variance, or normals at touches. O(points), in at most 16 passes.
std::optional<CoherentMoment> coherent_moment(const CanonicalFit& placed, const FitData& reduced,
                                              const Likelihood& likelihood, double sigma,
                                              double scatter, WorkBudget& work);

}  // namespace palpate
