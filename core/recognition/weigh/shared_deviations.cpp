#include "core/recognition/weigh/shared_deviations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/numerics/probability/log_add.h"
#include "core/recognition/coherent/coherent_gain.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/weigh/near_best.h"

namespace palpate {
namespace {

/// -infinity where no class has any evidence.
double log_sum(const ByClass<double>& logs) {
  return std::accumulate(logs.begin(), logs.end(), -std::numeric_limits<double>::infinity(),
                         log_add);
}

/// The classes that such deviations are asked of, the best of all first: what leaves less
/// chi-square than the best has no more for them to explain, and is given what the best is.
std::vector<CurveClass> asked(const Contenders& contenders, const EvidenceContext& context) {
  const CurveClass best = best_class(contenders.fits, context.likelihood, contenders.evidences);
  if (best == CurveClass::Unclassified) {
    return {};
  }
  std::vector<CurveClass> classes{best};
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& fit = contenders.fits[curve_class];
    if (fit && !fit->at_limit && std::isfinite(fit->chi2) &&
        fit->chi2 > contenders.fits[best]->chi2 &&
        contenders.coarse[curve_class]->chi2 <= context.out_of_reach) {
      classes.push_back(curve_class);
    }
  }
  return classes;
}

/// Evidences of the classes without such deviations.
ByClass<double> with_noise_alone(const Contenders& contenders, const EvidenceContext& context) {
  ByClass<double> logs;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const auto& fit = contenders.fits[i];
    logs[i] = fit && !fit->at_limit ? log_evidence(context.likelihood, contenders.evidences, *fit)
                                    : kNoEvidence;
  }
  return logs;
}

/// The gain of a class over its evidence on all points, of one that the reduced points tell over
/// what they leave.
double over_all_points(double gain, CurveClass curve_class, const Contenders& contenders,
                       const EvidenceContext& context) {
  const Likelihood& likelihood = context.likelihood;
  const double difference =
      log_evidence(likelihood, contenders.evidences, *contenders.fits[curve_class]) -
      log_evidence(likelihood, contenders.evidences, curve_class,
                   chi2_without_deviation(contenders, context, curve_class));
  // Half of it is noise alone, which all points tell.
  const double log_half = std::log(0.5);
  const double of_deviations = gain + std::log1p(-std::exp(log_half - gain));
  return std::isfinite(difference) && gain > log_half
             ? log_add(log_half, of_deviations - difference)
             : gain;
}

}  // namespace

Contenders with_shared_deviations(Contenders contenders, const EvidenceContext& context,
                                  bool of_any_size, double margin) {
  const std::vector<CurveClass> classes = asked(contenders, context);
  for (const CurveClass curve_class : classes) {
    weigh_on_reduced(curve_class, context, &contenders);
  }
  const ByClass<double> white = with_noise_alone(contenders, context);
  const double paths = log_evidence_of_unclassified(context.likelihood, contenders.evidences,
                                                    context.arcs.smooth.chi2);
  const double matters = log_sum(white) - margin;
  const bool may_be_other =
      of_any_size && !classes.empty() &&
      (paths > matters || log_evidence_near_best(classes.front(), kLargestFormError, matters,
                                                 contenders, context) > matters);
  if (classes.size() < 2 && !may_be_other) {
    return contenders;
  }
  // A stated noise is all by which a probe errs.
  const double most = of_any_size ? std::numeric_limits<double>::infinity() : 1.0;
  ByClass<double> gain{};
  for (const CurveClass curve_class : classes) {
    if (!context.work.allows()) {
      return contenders;
    }
    const auto& evidence = contenders.evidences.classes[curve_class];
    const auto& placed = contenders.evidences.on_reduced[curve_class];
    auto own = evidence && placed
                   ? log_coherent_gain(*placed, *evidence,
                                       points_of(*contenders.coarse[curve_class], context.reduced),
                                       context.likelihood, context.arcs.sigma,
                                       context.arcs.smooth.chi2, most, context.work)
                   : std::nullopt;
    if (own) {
      own = over_all_points(*own, curve_class, contenders, context);
    }
    if (curve_class == classes.front()) {
      gain.fill(own.value_or(0.0));
    } else if (own) {
      gain[curve_class] = *own;
    }
  }
  ByClass<double> shared;
  for (std::size_t i = 0; i < white.size(); ++i) {
    shared[i] = white[i] + gain[i];
  }
  contenders.evidences.shared_or_other = may_be_other && log_sum(shared) > paths;
  const double more = contenders.evidences.shared_or_other ? 0.0 : log_sum(shared) - log_sum(white);
  if (!std::isfinite(more)) {
    return contenders;
  }
  for (std::size_t i = 1; i < gain.size(); ++i) {
    contenders.evidences.log_shared[i] = gain[i] - more;
  }
  return refine_plausible(std::move(contenders), context, margin);
}

}  // namespace palpate
