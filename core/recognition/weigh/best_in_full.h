// The best class with all that a probe says of its samples: noise across its own curve, and normals
// measured along strokes.
#pragma once

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// The data with covariances that are left in `open`, of the same points, weighed by what of them
/// lies across a curve at their feet: they are used up then.
FitData weighed_across(const CanonicalFit& placed, const FitData& open, FitData data);

/// The best class at the optimum of places, weighed by their noise across the curve itself, and of
/// normals, with the covariance of both. `w.residuals` counts the normals; odds of the classes are
/// those of the places. Where neighbours err together, nothing tells what a normal is worth beside
/// that: none along a stroke counts. Single normals that the curve leaves beyond any noise are left
/// aside. `w.data` is left with the details that do not count. `data`: of the same points, with the
/// covariances. O(points).
Weighing best_in_full(Weighing w, const FitData& data, WorkBudget& work);

}  // namespace palpate
