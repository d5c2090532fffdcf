// How chi-squares count: with known or unknown noise, and with form error stated or seen.
#pragma once

namespace palpate {

struct Likelihood {
  bool sigma_known = true;  ///< false: the noise's scale is integrated out, with prior 1 / sigma
  double samples = 0.0;     ///< effective number of independent samples
  double tempering = 1.0;   ///< correlation time and misfit: chi-square is divided by it
  double chi2_floor = 0.0;  ///< chi-square from rounding alone, if the noise is not known
  /// Upper bound on the variance that stated form error adds to any combination of residuals, in
  /// units of the tempered noise's. The difference of a chi-square from `noise_chi2`, the smooth
  /// model's, is divided by 1 + coherent_variance. This stands for the integral over all
  /// correlations of the form error, bounded by the worst of them (core/README.md, "Stated form
  /// error").
  double coherent_variance = 0.0;
  double noise_chi2 = 0.0;

  /// True if `tempering` is for residuals correlated along the arc. They may be a smooth deviation
  /// from the class or another shape: the data cannot tell which.
  bool coherent_or_other = false;

  /// Factor on the variances of residuals.
  double inflation() const { return tempering * (1.0 + coherent_variance); }

  /// The part of it for stated form error.
  double form_inflation() const { return tempering * coherent_variance; }

  /// Chi-square after tempering and form error.
  double counted(double chi2) const;

  /// For unknown noise: the chi-square that estimates it, above 0, and its degrees of freedom if
  /// the data determine that many coordinates.
  double left(double chi2) const;
  double freedom(double determined) const;

  /// log of the evidence of a model, up to a constant that all models share. Arguments: chi-square
  /// at its optimum, log of what the prior leaves of that likelihood, number of determined
  /// coordinates.
  double log_evidence(double chi2, double log_occam, double determined) const;
};

/// Chi-square for the misfit test: form error counts, correlation does not. It is at most chi2,
/// because a class with a smaller one than the smooth model (which cannot follow every bend) has no
/// form error in it.
double misfit_of(double chi2, const Likelihood& likelihood);

/// log(p / (1 - p)): the difference of log evidences at which the better of two has this
/// probability, in (0, 1).
double log_odds(double probability);

}  // namespace palpate
