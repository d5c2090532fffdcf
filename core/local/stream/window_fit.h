// Fit of one window of a path: tangent angle, kappa and kappa_s at its middle. The covariance
// contains both the noise and the bias that the length of the window causes.
#pragma once

#include <span>

#include "core/local/local_status.h"
#include "core/local/stream/node_pyramid.h"

namespace palpate {

/// `nodes`: in the order of travel. `noise`: standard deviation of a node of weight 1 [m
/// sqrt(weight)]; this is 1 for weights 1/sigma_i^2 and the samples' sigma for weights 1.
/// `form_deviation_m`: smooth deviation of the part from its curve, one standard deviation.
///
/// The fit is a polynomial of degree 8 in the frame of the window. Its terms beyond the third have
/// a prior that falls off geometrically; the evidence of the terms determines its size and its
/// fall-off. The first terms that the polynomial lacks enter the covariance with the variance of
/// the prior. core/README.md, "The sliding window".
///
/// NotFollowed: the two highest terms of the polynomial exceed the noise; a shorter window may
/// succeed. With `may_enlarge_noise`, for windows that cannot be shortened and whose noise nobody
/// stated, the noise is taken to be as large as those terms.
LocalResult fit_window(std::span<const PathNode> nodes, double noise, double form_deviation_m,
                       bool may_enlarge_noise = false);

/// Fewest nodes of a window; with fewer there is no estimate.
inline constexpr std::size_t kFewestWindowNodes = 16;

}  // namespace palpate
