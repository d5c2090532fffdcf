// Estimates the size of the higher terms of a window's polynomial, which cause its bias, from the
// terms themselves. core/README.md, "What is left of bias".
#pragma once

#include <Eigen/Core>

namespace palpate {

/// Terms of a window's polynomial. c_0 ... c_3 determine position, angle, kappa and kappa_s, and
/// are free. The terms from kFirstPrior on have a prior.
inline constexpr int kWindowDegree = 8;
inline constexpr int kWindowSize = kWindowDegree + 1;
inline constexpr int kFirstPrior = 4;
inline constexpr int kPriorTerms = kWindowSize - kFirstPrior;
/// Terms beyond the polynomial that enter the covariance: an odd one for kappa_s and an even one
/// for kappa.
inline constexpr int kTailTerms = 2;

/// What the data say about the terms from kFirstPrior on.
struct HigherTerms {
  /// Variances of one prior. It keeps the same share of each term as the grid's points do on
  /// average.
  Eigen::Matrix<double, kPriorTerms, 1> variances;
  /// Variances of the terms that the polynomial lacks.
  Eigen::Matrix<double, kTailTerms, 1> tail_variances;
  /// Covariance, over the grid, of the kept shares of the terms.
  Eigen::Matrix<double, kPriorTerms, kPriorTerms> apart;
};

/// Posterior over a grid of priors. The evidence is that of the terms `c` of the free fit with
/// their `variance`; correlations are neglected.
HigherTerms higher_terms(const Eigen::Matrix<double, kWindowSize, 1>& c,
                         const Eigen::Matrix<double, kWindowSize, 1>& variance);

}  // namespace palpate
