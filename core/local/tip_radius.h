// From the path of a round tip's centre to the surface that the tip touches.
#pragma once

#include <optional>

#include "core/local/local_estimate.h"

namespace palpate {

/// Estimate of the surface from an estimate of the centre's path. The centres lie on the offset
/// curve c = p + d n, where n is the left normal of travel and d = `tip_offset_m` is signed: +
/// radius if the material lies right of travel, - radius if it lies left. From ds_c = (1 - d kappa)
/// ds:
///   kappa   = kappa_c / (1 + d kappa_c)
///   kappa_s = kappa_cs / (1 + d kappa_c)^3
/// The tangent angle is the same. The covariance is transformed too: an error of the angle turns
/// the radius and so moves the point along the surface, where angle and kappa are different.
/// (kappa_s differs there as well, by the second derivative of kappa, which the estimate does not
/// have; this is omitted.) nullopt if 1 + d kappa_c <= 0: no tip of this radius can follow such a
/// path on this side. With -d it is the way back, from the surface to the
/// path of the centre.
std::optional<LocalEstimate> surface_from_tip(const LocalEstimate& centre, double tip_offset_m);

}  // namespace palpate
