// The jet: one local polynomial in a frame along the window. It gives position, tangent angle,
// kappa and kappa_s with their joint covariance. Derivation: core/README.md, "Local estimation".
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

/// 3 is the lowest degree that has a kappa_s; 5 also removes the next order of its bias.
inline constexpr int kMinJetDegree = 3;
inline constexpr int kMaxJetDegree = 5;

struct JetOptions {
  /// Degree of the polynomial, clamped to [kMinJetDegree, kMaxJetDegree]. Each degree removes the
  /// bias of its own order. An odd degree increases the variance of kappa_s, an even one that of
  /// kappa.
  int degree = 4;
  /// Isotropic noise of the position, one standard deviation; 0 = estimate it from the residuals.
  /// [m]
  double sigma_m = 0.0;
  /// Where in the window: -1 its start, 0 its centre, 1 its end, along the window's axis. At an end
  /// kappa_s has about 8 times the standard deviation that it has at the centre (degree 4).
  double place = 0.0;
};

/// Needs degree + 1 samples, and 4 more if it must estimate the noise. O(samples): three passes and
/// two Cholesky factorisations of size degree + 1. Does not allocate.
///
/// The covariance is exact to first order in the noise; weights 1 / (1 + slope^2) account for noise
/// along the abscissa. To second order, that noise shifts the coefficient of P_k by about (sigma /
/// half extent) slope sqrt((2k + 1) samples) of its standard deviation, where slope is that of the
/// window's ends against its axis: 0.1 for 111 samples, half extent 200 sigma, slope 0.5, k = 6.
LocalResult jet_estimate(std::span<const Vec2> samples, const JetOptions& options = {});

/// The estimates at several places of one window, from one fit. `results`: one per place.
void jet_estimates(std::span<const Vec2> samples, const JetOptions& options,
                   std::span<const double> places, std::span<LocalResult> results);

}  // namespace palpate
