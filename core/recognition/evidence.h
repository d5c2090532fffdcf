// Which class do the data speak for? Bayesian information criterion over the refined fits.
#pragma once

#include <array>
#include <cmath>

#include "core/curves/curve_class.h"
#include "core/recognition/class_fits.h"

namespace palpate {

/// What the evidence is weighed with.
struct EvidenceScale {
  bool sigma_known = true;  ///< false: the noise is profiled out
  double samples = 0.0;     ///< effective number of independent samples
  double tempering = 1.0;   ///< correlation time and misfit: chi-square counts 1 / tempering
  double chi2_floor = 0.0;  ///< chi-square that rounding alone leaves (noise profiled out)
  double parsimony = 1.0;   ///< price of a parameter, in units of Schwarz's log(n)
  /// What the stated form error may add to the variance of a residuals' combination, beside the
  /// noise's 1: what chi-square differs by from `noise_chi2`, the smooth model's, counts
  /// 1 / (1 + coherent_variance).
  double coherent_variance = 0.0;
  double noise_chi2 = 0.0;
};

/// Indexed by CurveClass; entry 0 is "unclassified".
using ClassProbabilities = std::array<double, 9>;

/// Information criterion of a model: -2 log(evidence) up to a constant. With the noise known
/// chi2 + k log n, otherwise n log(chi2) + k log n (G. Schwarz, "Estimating the dimension of a
/// model", 1978; core/README.md, "Evidence").
double information_criterion(double chi2, double parameters, const EvidenceScale& scale);

/// The difference of criteria at which the better of two has this probability, in (0, 1).
inline double criterion_of_odds(double probability) {
  return 2.0 * std::log(probability / (1.0 - probability));
}

/// Chi-square with what may be stated form error tempered (core/README.md, "Stated form error").
double without_form_error(double chi2, const EvidenceScale& scale);

/// -2 log(likelihood) up to a constant.
double misfit(double chi2, const EvidenceScale& scale);

/// Posterior probabilities of the classes that were fitted and of "unclassified", whose model is
/// the smooth one. Classes that were not fitted get 0. Ellipse and hyperbola are the two sides of
/// one family of conics: where it has a single optimum, its evidence is divided between them in the
/// ratio of the normal probabilities on either side of the parabola, Phi(+-sqrt(chi2 difference)).
/// A semi-cubical parabola far from its vertex is a parabola and a small cubic term, as a cubical
/// parabola far from its inflection is: where both fit alike they are one hypothesis, counted once.
ClassProbabilities probabilities(const ClassFits& fits, double smooth_chi2, int smooth_parameters,
                                 const EvidenceScale& scale);

}  // namespace palpate
