// The jet: one local polynomial in a frame aligned with the window gives position, tangent angle,
// kappa and kappa_s with their joint covariance. Derivation: core/README.md, "Local estimation".
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

/// The least that has a kappa_s; the largest takes the bias of next order from it as well.
inline constexpr int kMinJetDegree = 3;
inline constexpr int kMaxJetDegree = 5;

struct JetOptions {
  /// Degree of the polynomial, clamped to [kMinJetDegree, kMaxJetDegree]. An odd degree adds
  /// variance to kappa_s, an even one to kappa, and each removes the bias of its own order.
  int degree = 4;
  /// Isotropic position noise, one standard deviation; 0 = estimate it from the window's
  /// residuals. [m]
  double sigma_m = 0.0;
  /// Where on the window: -1 its start, 0 its centre, 1 its end, along the window's axis. kappa_s
  /// at an end has about 8 times the standard deviation of the centre's (degree 4).
  double place = 0.0;
};

/// Cost O(samples): three passes and two Cholesky factorisations of size degree + 1; no allocation.
///
/// The covariance is exact to first order in the noise: noise along the abscissa is accounted for
/// by weights 1 / (1 + slope^2). To second order it shifts the coefficient of P_k by about
/// (sigma / half extent) slope sqrt((2k + 1) samples) of its standard deviation, with the slope at
/// the window's ends against its axis: 0.1 for 111 samples, half extent 200 sigma, slope 0.5, k
/// = 6. Needs degree + 1 samples, and 4 more where it must estimate the noise.
LocalResult jet_estimate(std::span<const Vec2> samples, const JetOptions& options = {});

/// The same at several places of one window, which share the fit. `results`: one per place.
void jet_estimates(std::span<const Vec2> samples, const JetOptions& options,
                   std::span<const double> places, std::span<LocalResult> results);

}  // namespace palpate
