// Directions and bends where the samples of a round tip do not show them by themselves.
#pragma once

#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// Whether any tip's centre is among the points that were too few to be smoothed.
bool has_kept_tips(const SmoothModel& smooth);

/// Whether any of these has no direction from elsewhere (StoredPatch::direction).
bool has_untold_tips(const SmoothModel& smooth);

/// Whether any patch of tips' centres bends less for certain than noise may bend it, and its bend
/// is not told either.
bool has_uncertain_bends(const SmoothModel& smooth);

enum class DirectionsOf { UntoldPoints, KeptPoints, AllPoints };

/// Gives points of `touches` (the smooth model's reduced points) the tangents of a curve that was
/// fitted to them, or to a curve parallel to theirs: parallel curves have the same normals. Their
/// sense is that of the whole patch's travel along the curve; a patch that shows none gets the
/// curve's. Returns the largest angle by which one has turned. [rad]
double set_directions(DirectionsOf which, const CanonicalFit& curve, const SmoothModel& smooth,
                      FitData* touches, WorkBudget& work);

/// The sides to which the patches bend (tip_sides.h): as they turn by themselves, where that is
/// certain, else as the curve through the tips' centres bends beside them.
std::vector<double> bends_of(const CanonicalFit& curve, const FitData& touches, WorkBudget& work);

/// Whether the patches travel along the curve as its parameter rises (1) or falls (-1); 0 where
/// they show no direction.
std::vector<double> senses_of(const CanonicalFit& curve, const FitData& touches, WorkBudget& work);

}  // namespace palpate
