// From the curve of a round tip's centres back to the surface that the tip touched.
#pragma once

#include <optional>

#include "core/local/local_estimate.h"

namespace palpate {

/// The centres run on the offset curve c = p + d n, n the left normal of the travel and `d` the
/// signed `tip_offset_m`: + radius where the material lies on the right of the travel, - radius
/// where it lies on the left. With ds_c = (1 - d kappa) ds:
///   kappa   = kappa_c / (1 + d kappa_c)
///   kappa_s = kappa_cs / (1 + d kappa_c)^3
/// and the tangent angle is the same. The covariance is taken along: an error of the angle turns
/// the radius and so moves the point along the surface, over which angle and kappa change (kappa_s
/// too, by the second derivative of kappa, which the estimate does not know: left out).
/// nullopt where 1 + d kappa_c <= 0: no tip of this radius runs along such a curve on this side.
std::optional<LocalEstimate> surface_from_tip(const LocalEstimate& centre, double tip_offset_m);

/// The way back: what the tip's centre does along a surface. nullopt where 1 - d kappa <= 0: the
/// tip does not fit into the hollow.
std::optional<LocalEstimate> tip_from_surface(const LocalEstimate& surface, double tip_offset_m);

}  // namespace palpate
