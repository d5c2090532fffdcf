// The paper's two rounds of quadratic fits (section 6.1): curvature from overlapping windows of
// samples, and its derivative from a second fit of curvature against arc length.
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

inline constexpr int kMaxTwoRoundFits = 64;

struct TwoRoundOptions {
  int samples_per_fit = 75;  ///< the paper's n; at least 4
  int shift = 4;             ///< the paper's l: samples from one window to the next; at least 1
  int fits = 10;             ///< the paper's m; 3 to kMaxTwoRoundFits
  double sigma_m = 0.0;      ///< noise; 0 = estimate it from the residuals of the middle fit [m]
};

/// Number of samples that one estimate uses: n + (m - 1) l.
int two_round_samples(const TwoRoundOptions& options);

/// The estimate at the median sample of the middle one of the m windows, from the first
/// two_round_samples of `samples`. Tangent angle and kappa come from the middle window. kappa_s is
/// the slope, at that window's arc length, of the quadratic through the m curvatures. Arc lengths
/// are by Simpson's rule between the medians. O(n m); does not allocate.
///
/// The covariance accounts for the noise of all samples to first order, with the overlap of the
/// windows. The noise of the arc lengths is omitted (relative error sigma / window). Bias of the
/// tangent angle: kappa_s W^2 / 40, W the arc length of one window (u^3 contains 3/5 of P_1). Bias
/// of kappa: W^2 / 56 times the fourth derivative of the graph (u^4 contains 4/7 of P_2). Bias of
/// kappa_s: the slope of that bias.
LocalResult two_round_estimate(std::span<const Vec2> samples, const TwoRoundOptions& options = {});

}  // namespace palpate
