// The jet over all of a patch that is a graph, its polynomial's higher terms held back by as much
// as the data say: bias and variance in balance. Derivation: core/README.md, "Local estimation".
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/local/local_status.h"

namespace palpate {

enum class PatchPlace { Start, Centre, End };

struct AdaptiveJet {
  LocalResult result;  ///< its covariance holds the terms' uncertainty too, not the noise alone
  std::size_t first_sample = 0;  ///< of the window
  std::size_t samples = 0;
};

/// Below this many samples the answer is the plain jet of degree 4 over all of them.
inline constexpr std::size_t kAdaptiveSamples = 18;

/// The estimate at a patch's start, centre or end. `sigma_m`: noise, 0 = estimate_noise of the
/// patch.
///
/// The window is the longest at the place that stays within 45 degrees of its axis and that a
/// polynomial of degree 8 explains (its two highest terms not significant at 1 %), or else the
/// shortest that it could be fitted to. On [-1, 1] the
/// Legendre coefficients of an analytic curve fall off geometrically; those beyond the third get
/// the prior N(0, (A rho^(k - 2))^2), with A and rho averaged over a grid by the evidence of the
/// coefficients themselves. Where the noise is small the terms are fitted, where it is large they
/// stay near zero with their prior's uncertainty: no window length or degree is chosen, and what
/// the window's length costs in bias stands in the covariance.
///
/// Cost O(samples), about ten jets; no allocation with the noise given. For a patch's ends and
/// centre, not for every sample.
AdaptiveJet adaptive_jet(std::span<const Vec2> patch, PatchPlace place, double sigma_m = 0.0);

/// adaptive_jet at start, centre and end of a patch, the noise estimated once.
std::array<AdaptiveJet, 3> patch_estimates(std::span<const Vec2> patch, double sigma_m = 0.0);

}  // namespace palpate
