// The likelihood of the residuals: noise from the arcs, and deviations of the part.
#pragma once

#include <optional>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// Of the half extent: 50 um on a part 100 mm across, where ISO 286-1 has 54 um for grade IT8,
/// which turning and milling hold. Beyond it, it is another shape, if free paths of the patches say
/// so too. (Of touches that lie apart they say nothing.) A part made less truly is for
/// `form_deviation_m`.
inline constexpr double kLargestFormError = 1e-3;

/// True if the noise is known or the smooth model can estimate it, without any class.
bool noise_is_known_without_class(const Arcs& arcs, const Likelihood& likelihood);

/// `form_deviation_m`: stated standard deviation of parts from their class; 0 = none [m].
Likelihood likelihood_of(const Arcs& arcs, double form_deviation_m);

/// What the residuals of the best class show beyond the noise known before.
struct ResidualExcess {
  /// The likelihood with this deviation, if it is noise or form error rather than another class.
  std::optional<Likelihood> likelihood;
  /// Factor on the variances of residuals: neighbours that err together, and larger noise.
  double noise_inflation = 1.0;
  /// It is larger than stated by the residuals of the class alone: the smooth model, if there is
  /// one, finds the noise that is stated. The class may be wrong as well.
  bool told_by_class_alone = false;
  /// Variance of the white noise in it, in units of the arcs' sigma^2.
  double white_variance = 1.0;
  /// Additional factor on covariances: a noise estimated from few residuals may be larger.
  double student_inflation = 1.0;
  /// True if neighbours may err together; the evidence must decide.
  bool correlated = false;
  double correlation_length = 0.0;  ///< correlation length of the residuals, normalised; 0 = white
};

/// `chi2`: of the class on all points. `placed`: the class there. `unclassified`: true if
/// "unclassified" is the most probable.
ResidualExcess residual_excess(const Arcs& arcs, const Likelihood& likelihood, double chi2,
                               const CanonicalFit& placed, bool unclassified);

}  // namespace palpate
