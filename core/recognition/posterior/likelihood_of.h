// The law of the residuals: noise as the arcs tell it, and what the part may deviate by.
#pragma once

#include <optional>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// Whether the noise is known without any class.
bool tells_noise(const Arcs& arcs, const Likelihood& likelihood);

/// `form_deviation_m`: the stated standard deviation of parts from their class; 0 = none.
Likelihood likelihood_of(const Arcs& arcs, double form_deviation_m);

/// What the best class leaves beyond the noise that the law before knew of.
struct SeenDeviation {
  /// The law with it, where it is noise or form error rather than another class.
  std::optional<Likelihood> likelihood;
  double noise_inflation = 1.0;  ///< what variances of residuals count times
  double white_variance = 1.0;   ///< of the noise among it, in units of the arcs' sigma^2
  /// What covariances are to be multiplied with beside that: a noise that few residuals tell may be
  /// larger than they say.
  double few_residuals = 1.0;
  /// Whether neighbours may err together, which the evidence is to say.
  bool correlated = false;
  double correlation_length = 0.0;  ///< over which residuals err together, normalised; 0 = white
};

/// `chi2`: of the class on all points; `placed`: the class there; `unclassified`: whether the
/// posterior has it for none.
SeenDeviation seen_deviation(const Arcs& arcs, const Likelihood& likelihood, double chi2,
                             const CanonicalFit& placed, bool unclassified);

}  // namespace palpate
