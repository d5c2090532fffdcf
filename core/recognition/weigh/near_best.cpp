#include "core/recognition/weigh/near_best.h"

#include <algorithm>
#include <cmath>

#include "core/recognition/coherent/near_class.h"

namespace palpate {
namespace {

/// log of the prior probability of parts near one class, over that of the class. All together they
/// are as improbable as what a RECOGNIZED answer usually leaves to doubt, 0.05 beside 0.95: it
/// takes evidence to doubt a class.
const double kLogOfParts = -std::log(19.0 * static_cast<double>(kCurveClasses.size()));

}  // namespace

double log_evidence_near_best(CurveClass best, double least_size, double least,
                              const Contenders& contenders, const EvidenceContext& context) {
  const Arcs& arcs = context.arcs;
  const auto& evidence = contenders.evidences.classes[best];
  const auto& placed = contenders.evidences.on_reduced[best];
  if (!evidence || !placed) {
    return kNoEvidence;
  }
  // Of the class with noise alone: what neighbours share is a deviation already.
  const double of_class = log_evidence(context.likelihood, contenders.evidences, best,
                                       chi2_without_deviation(contenders, context, best)) -
                          contenders.evidences.log_shared[best];
  const auto gain = log_gain_near_class(
      *placed, *evidence, points_of(*contenders.coarse[best], context.reduced), context.likelihood,
      arcs.sigma, arcs.smooth.chi2, least_size, least - of_class - kLogOfParts, context.work);
  return gain ? of_class + kLogOfParts + *gain : kNoEvidence;
}

}  // namespace palpate
