// Directions and bends for round-tip samples that do not show them themselves.
#pragma once

#include <span>
#include <vector>

#include "core/curves/rounded_corner.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// True if any tip centre is among the points that no polynomial fits (ReducedSection::kept).
bool has_kept_tips(const SmoothModel& smooth);

/// True if any of these has no known direction (StoredPatch::direction).
bool has_untold_tips(const SmoothModel& smooth);

/// Whether noise sways the direction of a tip's centre by so much that the tip, taken off along it,
/// may miss the surface by more than the noise of the point.
bool is_swayed(const FitPoint& centre);

/// True if any tip's centre is.
bool has_swayed_tips(const SmoothModel& smooth);

/// True if any patch of tip centres has neither a known side (`sides`, one per patch, else 0) nor a
/// significant bend (certain_turn) nor a known direction.
bool has_uncertain_bends(const SmoothModel& smooth, std::span<const int> sides);

enum class DirectionsOf { UntoldPoints, KeptPoints, AllPoints };

/// Of a tip's centre: the place of the curve that is nearest, or, on a surface that all centres lie
/// beside at their radii as noise lets them, the one that was touched. That may have another arm
/// which is nearer.
enum class Feet { Nearest, Touched };

/// Gives points of `touches` (the smooth model's reduced points) the tangents of a curve fitted to
/// them or to a parallel curve, which has the same normals. The sense is that of the whole patch's
/// travel along the curve; a patch that shows none gets the curve's sense. Returns the largest turn
/// of a tangent. [rad]
double set_directions(DirectionsOf which, const CanonicalFit& curve, Feet feet,
                      const SmoothModel& smooth, FitData* touches, WorkBudget& work);

/// The directions of strokes' points that no polynomial follows, from a curve that all tips'
/// centres lie on as noise lets them. Their errors are what noise turns the line between neighbours
/// by: any other curve that has the centres, too, has these directions but for that. (Chords lead
/// round a bend, and are off by half its turn.)
void tell_directions(const CanonicalFit& curve, const SmoothModel& smooth, FitData* touches,
                     WorkBudget& work);
/// Returns the sides to which edges bend from the patches' travel.
std::vector<double> tell_directions(const RoundedCorner& edges, const SmoothModel& smooth,
                                    FitData* touches, WorkBudget& work);

/// The sides to which the patches bend (tip_sides.h), > 0 for left: from their own turn if it is
/// significant, else from the curvature of the curve through the tip centres.
std::vector<double> bends_of(const CanonicalFit& curve, const FitData& touches, WorkBudget& work);

/// For each patch: 1 if it travels along the curve with increasing parameter, -1 if against it, 0
/// if it shows no direction.
std::vector<double> senses_of(const CanonicalFit& curve, const FitData& touches, WorkBudget& work);

}  // namespace palpate
