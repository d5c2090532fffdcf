// How chi-squares count: noise known or not, form error stated or seen.
#pragma once

namespace palpate {

struct Likelihood {
  bool sigma_known = true;  ///< false: the noise's scale is integrated out, prior 1 / sigma
  double samples = 0.0;     ///< effective number of independent samples
  double tempering = 1.0;   ///< correlation time and misfit: chi-square counts 1 / tempering
  double chi2_floor = 0.0;  ///< chi-square that rounding alone leaves, where the noise is not known
  /// What stated form error may add to the variance of any combination of residuals, beside the
  /// noise's 1: what chi-square differs by from `noise_chi2`, the smooth model's, counts
  /// 1 / (1 + coherent_variance). The integral over all correlations of the form error, bounded by
  /// the worst of them (core/README.md, "Stated form error").
  double coherent_variance = 0.0;
  double noise_chi2 = 0.0;

  /// The tempering is for residuals that are correlated along the arc: coherent deviation from a
  /// class, or another shape, which the data cannot tell apart.
  bool coherent_or_other = false;

  /// What the variances of residuals count times.
  double inflation() const { return tempering * (1.0 + coherent_variance); }

  /// Chi-square as it counts.
  double counted(double chi2) const;

  /// Where the residuals tell the noise: what they tell it by, above 0, and how many they are
  /// beyond so many coordinates.
  double left(double chi2) const;
  double freedom(double determined) const;

  /// log of the evidence of a model, up to what all models share: chi-square at its optimum, log of
  /// what its prior leaves of that likelihood, and how many coordinates the data determine.
  double log_evidence(double chi2, double log_occam, double determined) const;
};

/// Chi-square as a misfit is judged by it: form error counts, correlation does not. A class that
/// leaves less than the smooth model (which cannot follow every bend) has no form error in it.
double misfit_of(double chi2, const Likelihood& likelihood);

/// The difference of log evidences at which the better of two has this probability, in (0, 1).
double log_odds(double probability);

}  // namespace palpate
