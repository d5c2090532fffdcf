// The jet: one local polynomial in a frame aligned with the window gives position, tangent angle,
// kappa and kappa_s with their joint covariance. Derivation: core/README.md, "Local estimation".
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

inline constexpr int kMinJetDegree = 3;
inline constexpr int kMaxJetDegree = 6;

struct JetOptions {
  /// Degree of the polynomial, clamped to [kMinJetDegree, kMaxJetDegree]. An odd degree adds
  /// variance to kappa_s, an even one to kappa, and each removes the bias of its own order.
  int degree = 4;
  /// Isotropic position noise, one standard deviation; 0 = estimate it from the window's
  /// residuals. [m]
  double sigma_m = 0.0;
  /// Where on the window: -1 its start, 0 its centre, 1 its end, along the window's axis. kappa_s
  /// at an end has about 12 times the standard deviation of the centre's (degree 4).
  double place = 0.0;
};

/// Cost O(samples): three passes and two Cholesky factorisations of size degree + 1; no allocation.
///
/// The covariance is exact to first order in the noise. Noise along the abscissa is accounted for
/// to first order by weights 1 / (1 + slope^2); to second order it shrinks the coefficient of
/// degree k by a fraction of about (2k + 1) k (k + 1) / 2 (sigma / half extent)^2.
/// Needs degree + 1 samples, and 4 more where it must estimate the noise.
LocalResult jet_estimate(std::span<const Vec2> samples, const JetOptions& options = {});

}  // namespace palpate
