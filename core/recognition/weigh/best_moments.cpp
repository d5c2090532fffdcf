#include "core/recognition/weigh/best_moments.h"

#include <cmath>

#include "core/recognition/coherent/coherent_moment.h"
#include "core/recognition/fit/inverse_information.h"
#include "core/recognition/modes/across_circle.h"
#include "core/recognition/modes/moments.h"
#include "core/recognition/modes/slices.h"

namespace palpate {
namespace {

/// The covariance of a class where one that is linear about its estimate does not hold its valley.
std::optional<ShapePoseCovariance> covariance_of_valley(const ClassEvidence& evidence,
                                                        const CanonicalFit& on_reduced,
                                                        const CanonicalFit& best,
                                                        const FitData& reduced, double inflation,
                                                        WorkBudget& work) {
  const auto valley = by_slices(evidence, reduced, inflation, Slices::ForMoment, work);
  if (!valley || valley->widest < 0) {
    return std::nullopt;
  }
  return with_bend(inflation * best.covariance, inflation * on_reduced.covariance,
                   second_moment(on_reduced, *valley, reduced));
}

/// The same where the best is an ellipse that may be a circle: slices end there, and the valley
/// goes on with the axes in each other's place.
std::optional<ShapePoseCovariance> across_circle(const CanonicalFit& ellipse,
                                                 const ShapePoseCovariance& linear,
                                                 std::optional<ShapePoseCovariance> valley) {
  const ShapePoseCovariance within = valley.value_or(linear);
  const auto crossing = within.allFinite() ? moment_across_circle(ellipse, linear) : std::nullopt;
  return crossing ? bend_added(within, linear, *crossing).value_or(*crossing) : std::move(valley);
}

/// The moment where neighbours may err together: what such deviations leave unknown, with what the
/// valley's bend adds, as far as there are any. `valley`: covariance_of_valley, if there is one;
/// `bound`: of the noise alone; `inflation`: that of `valley`; `stated`: of it, for stated form
/// error.
ShapePoseCovariance with_coherence(const CoherentMoment& coherent,
                                   const std::optional<ShapePoseCovariance>& valley,
                                   const ShapePoseCovariance& bound, double inflation,
                                   double stated) {
  if (valley && !valley->allFinite()) {
    return *valley;
  }
  const ShapePoseCovariance linear = inflation * bound;
  const ShapePoseCovariance shared = coherent.moment + stated * bound;
  const ShapePoseCovariance bent =
      valley ? bend_added(shared, linear, *valley).value_or(shared) : shared;
  return coherent.probability * bent + (1.0 - coherent.probability) * (valley ? *valley : linear);
}

}  // namespace

BestMoments moments_of_best(const Weighing& w, WorkBudget& work) {
  BestMoments result;
  const auto& best = w.canonical[w.best];
  if (!w.best_evidence || !w.best_on_reduced || !best) {
    return result;
  }
  result.moment = covariance_of_valley(*w.best_evidence, *w.best_on_reduced, *best, w.reduced,
                                       w.inflation, work);
  if (w.best == CurveClass::Ellipse) {
    result.moment = across_circle(*best, w.inflation * best->covariance, result.moment);
  }
  if (result.moment) {
    result.white_moment = *result.moment / w.inflation;
  }
  if (w.seen.correlated) {
    const auto coherent =
        coherent_moment(*w.best_on_reduced, w.reduced, w.stated, w.sigma, w.smooth.chi2, work);
    if (coherent) {
      result.coherent_deviation = std::sqrt(coherent->probability) * coherent->deviation;
      result.moment = with_coherence(*coherent, result.moment, best->covariance, w.inflation,
                                     w.stated.form_inflation());
    }
  }
  if (result.moment && !(result.moment->diagonal().array() >= 0.0).all()) {
    // Its parts lie more than a double's digits apart, and rounding leaves less than nothing.
    result.moment = untold_covariance(result.moment->rows());
  }
  return result;
}

double in_steps(double told) {
  constexpr double kSteps = 2.0;  // to a factor of two
  return std::exp2(std::ceil(kSteps * std::log2(told)) / kSteps);
}

double told_deviation_m(const BestMoments& moments, double scale_m) {
  return moments.coherent_deviation > 0.0 ? scale_m * in_steps(moments.coherent_deviation) : 0.0;
}

}  // namespace palpate
