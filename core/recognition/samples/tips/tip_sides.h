// Round probe tips: on which side they lie, and the way from tip centres to surface points.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// Side on which the tip's centre lies according to the probe: +1 left of travel (material on the
/// right), -1 right, 0 not stated.
int stated_side(MaterialSide side);

/// Total turn of a patch, left positive (it may exceed a full turn), from the tangents of its
/// reduced points; nullopt if it is less than five standard deviations. [rad]
std::optional<double> certain_turn(std::span<const FitPoint> patch);

/// The turns of all patches, significant or not. [rad]
std::vector<double> turns_of(const FitData& reduced);

/// For each patch the side of its tips, as `PossibleSides::ways` has it, if measured normals show
/// it beyond doubt or else the probe states it; 0 where it is open or there is no tip.
std::vector<int> known_sides(std::span<const StoredPatch> patches, const FitData& reduced);

/// Whether all tips are of one radius, and the side of none is known.
bool are_open(std::span<const StoredPatch> patches, const FitData& data, const FitData& reduced);

/// Ways in which the tips may lie.
struct PossibleSides {
  /// Each has one side per patch, +1 if the tip centres lie left of travel, -1 right, 0 without a
  /// tip.
  std::vector<std::vector<int>> ways;
  /// Strokes whose side is not known, those that run together counted once.
  std::size_t open = 0;

  /// Whether the open strokes may lie in other ways too.
  bool may_be_otherwise() const {
    return open >= std::numeric_limits<std::size_t>::digits ||
           (std::size_t{1} << open) > ways.size();
  }
};

/// The possible sides of the tips. A patch's side is known as known_sides() has it, else if it runs
/// along a patch whose side is known (strokes_together.h). If all sides are known, there is one
/// way. Otherwise the unknown sides are such that the part is convex everywhere, concave
/// everywhere, or always on the left or always on the right of the curve, in this order. Patches
/// that run together bend as the one of them that bends most.
///
/// `bends`: side to which each patch bends, > 0 for left. `senses`: < 0 if a patch travels against
/// the curve; empty if no curve is known: then left and right are those of each patch's own travel.
/// A single touch has no travel, so that a stated side says nothing; its direction is its point's
/// tangent.
PossibleSides possible_sides(std::span<const StoredPatch> patches, const FitData& reduced,
                             std::span<const double> bends, std::span<const double> senses,
                             WorkBudget& work);

/// log likelihood of these sides by the signs of measured normals, up to a constant. Each patch's
/// may be too few to be beyond doubt and together tell the side of all.
double log_likelihood_of_normals(std::span<const StoredPatch> patches, const FitData& reduced,
                                 std::span<const int> sides);

/// Bound on the error of a surface point after the tip is removed along the tangent's normal: tip
/// radius times five standard deviations of the direction, at most the radius. `noise`: actual
/// noise in units of the assumed one.
double tip_removal_error(const FitPoint& point, double noise);

/// Moves reduced points from tip centres to the surface, along the normals of the centres' path.
/// These are also the normals of the surface. `sides`: one per patch.
FitData on_surface(const FitData& reduced, std::span<const int> sides);

}  // namespace palpate
