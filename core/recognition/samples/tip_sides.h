// Round probe tips: from tip centres to surface points.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// Where the probe says that the tip's centre lies: +1 left of travel (material on the right), -1
/// right, 0 where it does not say.
int stated_side(MaterialSide side);

/// By how much a patch turns from point to point, left positive (it may go all the way round), as
/// its reduced points' tangents say; nullopt where that is less than five standard deviations.
/// [rad]
std::optional<double> certain_turn(std::span<const FitPoint> patch);

/// The turns of all patches, certain or not.
std::vector<double> turns_of(const FitData& reduced);

/// The ways in which the material may lie beside the patches: +1 where a tip centre lies to the
/// left of travel, -1 to the right, per patch. One way where measured normals show it beyond doubt
/// (they know better than what is stated) or the probes say it; otherwise the part
/// is taken to be convex everywhere or concave everywhere, or on the same side of the curve all
/// along. Surface contacts (no tip radius) have the single way of zeros.
/// `bends`: the side to which each patch bends, > 0 for left. `senses`: < 0 where a patch travels
/// against the curve; empty where no curve is known, and the same side is that of every patch's own
/// travel. A touch alone in its patch has no travel that a probe could say a side of: its direction
/// is that of its point's tangent.
std::vector<std::vector<int>> possible_sides(std::span<const StoredPatch> patches,
                                             const FitData& reduced, std::span<const double> bends,
                                             std::span<const double> senses = {});

/// How far from the surface a point may be put where a tip is taken off along its tangent's normal:
/// as far as the direction's error turns the tip's radius. `noise`: in units of what is taken for
/// it.
double swayed_by(const FitPoint& point, double noise);

/// Reduced points moved from tip centres to the surface along the normals of the centres' path,
/// which are those of the surface.
FitData on_surface(const FitData& reduced, std::span<const int> sides);

}  // namespace palpate
