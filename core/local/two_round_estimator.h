// The paper's two rounds of quadratic fits (section 6.1): curvature from overlapping windows of
// samples, its derivative from a second fit of curvature against arc length.
#pragma once

#include <span>

#include "core/local/local_status.h"

namespace palpate {

enum class FitFrame {
  Aligned,  ///< each window's principal axis
  World,  ///< the world's x axis, as the paper prints it: fails on steep tangents. For comparison.
};

inline constexpr int kMaxTwoRoundFits = 64;

struct TwoRoundOptions {
  int samples_per_fit = 75;  ///< the paper's n, at least 4
  int shift = 4;             ///< the paper's l, samples from one window to the next, at least 1
  int fits = 10;             ///< the paper's m, 3 to kMaxTwoRoundFits
  double sigma_m = 0.0;      ///< noise; 0 = estimate it from the middle fit's residuals [m]
  FitFrame frame = FitFrame::Aligned;
};

/// Samples that one estimate takes: n + (m - 1) l.
int two_round_samples(const TwoRoundOptions& options);

/// The estimate at the median sample of the middle one of the m windows, from the first
/// two_round_samples of `samples`. Tangent angle and kappa are the middle window's, kappa_s is the
/// slope of the quadratic through the m curvatures at that window's arc length; arc lengths by
/// Simpson's rule between the medians.
///
/// The covariance is that of all samples to first order, the overlap of the windows included; the
/// noise of the arc lengths is left out (relative error sigma / window). Bias of kappa: W^2 / 56
/// times the fourth derivative of the graph, W the arc of one window (u^4 has 4/7 of P_2 in it); of
/// kappa_s: that derivative's slope likewise. Cost O(n m); no allocation.
LocalResult two_round_estimate(std::span<const Vec2> samples, const TwoRoundOptions& options = {});

}  // namespace palpate
