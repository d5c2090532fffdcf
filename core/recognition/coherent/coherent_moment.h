// What deviations that neighbours share leave unknown of shape and pose.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct CoherentMoment {
  /// That there are such deviations, as probable as none before anything is touched.
  double probability = 0.0;
  /// E[(x - estimate)(x - estimate)^T] of x = [shape; x; y; theta], given that there are.
  ShapePoseCovariance moment;
  /// Root mean square of them at a point, but for the offset's constant, which bends no path;
  /// normalised.
  double deviation = 0.0;
};

/// Residuals are noise, a drift along each patch and an offset by the direction of the normal, none
/// of whose sizes is known (core/README.md, "Deviations that neighbours share"): what of these the
/// shape takes up is as large as what it leaves over tells. Given the sizes all is linear about
/// `placed`, the class on `reduced`. `sigma`: noise of the typical point, normalised; `scatter`:
/// chi-square that all samples leave about the reduced points, whatever the class. nullopt where
/// there are too few points for a variance, and where touches have normals. Metres and radians,
/// world frame. O(points) some eighty times over.
std::optional<CoherentMoment> coherent_moment(const CanonicalFit& placed, const FitData& reduced,
                                              const Likelihood& likelihood, double sigma,
                                              double scatter, WorkBudget& work);

}  // namespace palpate
