// One window of a path: tangent angle, kappa and kappa_s at its middle, with the noise and what the
// window's length costs in bias in one covariance.
#pragma once

#include <span>
#include <vector>

#include "core/local/aligned_frame.h"
#include "core/local/local_status.h"
#include "core/local/stream/node_pyramid.h"

namespace palpate {

/// `nodes` in order of travel. `noise` is the standard deviation of a node of weight 1: with
/// weights 1/sigma_i^2 it is 1, with weights 1 the samples' sigma. [m] sqrt(weight)
/// `form_deviation_m`: smooth deviations of the part from its curve, one standard deviation.
///
/// A polynomial of degree 8 in the window's own frame; its terms beyond the third have a prior that
/// falls off geometrically, with size and rate by the evidence of the terms themselves, and the
/// first terms that the polynomial lacks stand in the covariance with the prior's variance.
/// core/README.md, "The sliding window".
///
/// NotFollowed where the polynomial's two highest terms are more than noise: a shorter window may
/// be followed. With `may_enlarge_noise`, where nobody stated it and no shorter window is left,
/// they are noise as large as they say.
LocalResult fit_window(std::span<const PathNode> nodes, double noise, double form_deviation_m,
                       bool may_enlarge_noise = false);

/// Fewest nodes of such a window; below, there is no estimate.
inline constexpr std::size_t kFewestWindowNodes = 16;

}  // namespace palpate
