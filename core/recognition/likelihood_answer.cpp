#include "core/recognition/likelihood_answer.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/counted/outliers.h"
#include "core/recognition/counted/weighed.h"
#include "core/recognition/verdict/determined.h"

namespace palpate {
namespace {

Hypothesis to_hypothesis(const Weighing& w, CurveClass curve_class) {
  Hypothesis hypothesis;
  hypothesis.shape.curve_class = curve_class;
  hypothesis.probability = w.probabilities[curve_class];
  if (curve_class == CurveClass::Unclassified) {
    hypothesis.chi2 = w.smooth.chi2;
    hypothesis.dof = w.smooth.dof();
    return hypothesis;
  }
  hypothesis.chi2 = w.fits[curve_class]->chi2;
  hypothesis.dof = static_cast<int>(w.residuals[curve_class]) - degrees_of_freedom(curve_class);
  hypothesis.at_limit = w.fits[curve_class]->at_limit;
  if (const auto& canonical = w.canonical[curve_class]) {
    hypothesis.shape = canonical->shape;
    hypothesis.world_T_curve = canonical->world_T_curve;
    hypothesis.covariance = w.inflation * canonical->covariance;
  }
  return hypothesis;
}

/// The first doubt about the most probable class.
Doubt doubt_about(const Weighing& w, const Hypothesis& best, const VerdictOptions& options,
                  std::size_t stored_samples) {
  // A misfit that is not noise may be form error or another class: the data cannot tell which.
  if (w.seen.correlation_length > 0.0) {
    return Doubt::FormError;
  }
  if (!(best.probability >= options.recognized_probability)) {
    return Doubt::SeveralClasses;
  }
  const CurveClass curve_class = best.shape.curve_class;
  // With that many, a bad fit may be due to spikes that were not found.
  const bool many_spikes = may_have_missed_spikes(stored_samples, w.data.points.size());
  if (many_spikes && !can_be_noise(w.counted_chi2, best.dof)) {
    return Doubt::Misfit;
  }
  if (curve_class == CurveClass::Unclassified) {
    if (!(w.margin_of_unclassified >= log_odds(options.recognized_probability))) {
      return Doubt::SeveralClasses;
    }
    // If not even the smooth model follows the samples, they say nothing about classes.
    return many_spikes || !can_be_noise(best.chi2, best.dof) ? Doubt::Misfit : Doubt::None;
  }
  if (best.at_limit || best.covariance.size() == 0) {
    return Doubt::AtLimit;
  }
  // A stated noise that nothing but the class's own residuals overrules still speaks against it,
  // and so do normals on the other side.
  if (w.seen.told_by_class_alone || w.sides_against_normals ||
      (best.dof > 0 && !can_be_noise(w.counted_chi2 / w.seen.noise_inflation, best.dof))) {
    return Doubt::Misfit;
  }
  // A second mode with more probability than RECOGNIZED may leave to doubt.
  const double odds = log_odds(options.recognized_probability);
  const bool has_rival = curve_class == CurveClass::CubicSpline &&
                         w.rival_share > 1.0 - options.recognized_probability;
  if (has_rival || w.sides_margin <= odds) {
    return Doubt::TwoShapes;
  }
  const bool means_something =
      !w.limit_is_as_good &&
      is_determined(best.shape, best.covariance, w.data.scale, options.determined_fraction);
  return means_something ? Doubt::None : Doubt::Undetermined;
}

}  // namespace

Recognition answer_by_likelihood(const Weighing& w, const BestMoments& moments,
                                 const VerdictOptions& options, std::size_t stored) {
  Recognition answer;
  for (std::size_t i = 0; i < w.probabilities.size(); ++i) {
    if (i == 0 || w.fits[i]) {
      answer.hypotheses.push_back(to_hypothesis(w, static_cast<CurveClass>(i)));
    }
  }
  std::stable_sort(
      answer.hypotheses.begin(), answer.hypotheses.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
  Hypothesis& best = answer.hypotheses.front();
  const auto& canonical = w.canonical[best.shape.curve_class];
  if (canonical && moments.moment) {
    best.covariance = *moments.moment;
  }
  if (canonical) {
    answer.white_covariance = moments.white_moment ? *moments.white_moment : canonical->covariance;
  }
  answer.shape = best.shape;
  answer.world_T_curve = best.world_T_curve;
  answer.covariance = best.covariance;
  answer.sigma_m = residual_noise_m(w);
  answer.noise_correlation_m =
      std::max(w.seen.correlation_length, noise_length(w.smooth, w.data)) * w.data.scale;
  answer.covariance_inflation = w.inflation;
  answer.unqualified_probe = w.unqualified_probe;
  answer.doubt = doubt_about(w, best, options, stored);
  answer.status =
      answer.doubt == Doubt::None ? RecognitionStatus::Recognized : RecognitionStatus::Ambiguous;
  return answer;
}

}  // namespace palpate
