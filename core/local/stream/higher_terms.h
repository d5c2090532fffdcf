// What a window's own terms say of those that its bias is made of. core/README.md, "What is left of
// bias".
#pragma once

#include <Eigen/Core>

namespace palpate {

/// Of a window's polynomial: c_0 ... c_3 carry position, angle, kappa, kappa_s and are free; the
/// terms from kFirstPrior on have a prior.
inline constexpr int kWindowDegree = 8;
inline constexpr int kWindowSize = kWindowDegree + 1;
inline constexpr int kFirstPrior = 4;
inline constexpr int kPriorTerms = kWindowSize - kFirstPrior;
/// Terms beyond the polynomial that the covariance knows of: an odd one for kappa_s and an even one
/// for kappa.
inline constexpr int kTailTerms = 2;

/// What the data say of the terms from kFirstPrior on.
struct HigherTerms {
  /// Of the one prior that keeps as much of each term as the grid's points do in the mean.
  Eigen::Matrix<double, kPriorTerms, 1> variances;
  /// Of the terms that the polynomial lacks.
  Eigen::Matrix<double, kTailTerms, 1> tail_variances;
  /// Covariance, over the grid, of the shares of the terms that its points keep.
  Eigen::Matrix<double, kPriorTerms, kPriorTerms> apart;
};

/// The posterior over a grid of priors by the evidence of the free fit's terms `c`, their
/// correlations left out.
HigherTerms higher_terms(const Eigen::Matrix<double, kWindowSize, 1>& c,
                         const Eigen::Matrix<double, kWindowSize, 1>& variance);

}  // namespace palpate
