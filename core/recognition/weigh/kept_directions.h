// Directions along the surface where samples stand so far apart that they do not show them.
#pragma once

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// Whether any tip's centre is among the points that were too few to be smoothed.
bool has_kept_tips(const SmoothModel& smooth);

/// The bend of the curve at touches that are alone in their patch.
struct LoneBend {
  double sum = 0.0;  ///< of curvatures, by the directions set [1/m]
};

/// Gives the kept points of `touches` (the smooth model's reduced points) the tangents of a curve
/// that was fitted to them, or to a curve parallel to theirs: parallel curves have the same
/// normals. A point that had a direction keeps its sense; one that had none gets the curve's.
LoneBend set_kept_directions(const CanonicalFit& curve, const SmoothModel& smooth,
                             FitData* touches);

}  // namespace palpate
