#include "core/recognition/weigh/contenders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/posterior/class_limits.h"

namespace palpate {
namespace {

double log_evidence_of(const ClassFit& fit, const Likelihood& likelihood,
                       const Evidences& evidences) {
  return log_evidence(likelihood, evidences, fit.curve_class, fit.chi2);
}

/// Whether a class, as the reduced points tell its chi-square, might keep the best from being
/// RECOGNIZED. `margin`: log odds that keep it from that; `error`: by how much chi-square may be
/// lower on all points.
bool is_plausible(const ClassFit& told, double highest, double margin, double error,
                  const Likelihood& likelihood, const Evidences& evidences) {
  const double chi2 = std::max(told.chi2 - error, 0.0);
  return std::isfinite(told.chi2) &&
         log_evidence(likelihood, evidences, told.curve_class, chi2) > highest - margin;
}

/// A class that is no such curve on all points.
ClassFit out(const ClassFit& coarse) {
  ClassFit fit = coarse;
  fit.weighed = true;
  fit.chi2 = std::numeric_limits<double>::infinity();
  return fit;
}

/// A class at its very optimum on all points, from its optimum on the reduced ones.
ClassFit polished(const ClassFit& settled, const SmoothModel& smooth, const FitData& data,
                  WorkBudget& work) {
  std::optional<ClassFit> fit;
  if (!settled.rival) {
    fit = refine_on_all(settled, smooth, data, kPolishEffort, work, RivalOf::Best);
  } else if (const auto refined =
                 refine_on_all(settled, smooth, data, kOnAllEffort, work, RivalOf::Best)) {
    // Not at once: the rival may be on its way to the same optimum.
    fit = polish(*refined, data, work);
  }
  ClassFit result = fit.value_or(out(settled));
  result.polished = true;
  return result;
}

/// A class as all points see it. Where they agree with the reduced points, and did so about the
/// best (`trusted`), it is left at its optimum there; otherwise (sections bent too sharply to be
/// followed to the noise, feet on the wrong arm) it has another one, or none.
ClassFit weighed(const ClassFit& coarse, const FitData& reduced, bool trusted,
                 const SmoothModel& smooth, const FitData& data, WorkBudget& work) {
  constexpr double kAgreement = 1.0;  // of chi-square: odds are right to a factor of 1.6
  if (trusted && is_what_it_says(coarse, reduced)) {
    ClassFit fit = coarse;
    fit.chi2 = chi2_on_all(coarse, smooth, data, work);
    fit.weighed = true;
    if (std::abs(fit.chi2 - (coarse.chi2 + smooth.chi2)) <= kAgreement) {
      return fit;
    }
  }
  return refine_on_all(coarse, smooth, data, kOnAllEffort, work).value_or(out(coarse));
}

/// Takes w->coarse of a class to its optimum on the reduced points, unless it is there, or leaves
/// more than any noise after all that a search has tried: that is no curve of the class.
const ClassFit& settle(std::size_t i, RivalOf rival, const FitData& reduced, Contenders* w,
                       WorkBudget& work) {
  if (w->coarse[i]->chi2 <= most_chi2_of_noise(reduced.points) &&
      (!w->fits[i]->weighed || (rival == RivalOf::Best && w->coarse[i]->rival))) {
    w->coarse[i] = settled(*w->coarse[i], reduced, rival, work);
  }
  return *w->coarse[i];
}

/// Classes that end at their limit, or worse than it, are what it is.
void take_limits(ClassFits* fits) {
  for (const CurveClass curve_class : kClassesWithLimit) {
    auto& fit = (*fits)[static_cast<std::size_t>(curve_class)];
    const auto limit = limit_of(curve_class, *fits);
    if (!fit || !limit) {
      continue;
    }
    const ClassFit& there = *(*fits)[static_cast<std::size_t>(*limit)];
    if (fit->at_limit || !(fit->chi2 <= there.chi2 + kWorseThanLimit)) {
      fit = there;
      fit->curve_class = curve_class;
      fit->at_limit = true;
    }
  }
}

}  // namespace

ClassFits with_inferred_chi2(const ClassFits& coarse, const SmoothModel& smooth) {
  ClassFits told = coarse;
  for (auto& fit : told) {
    if (fit) {
      fit->chi2 += smooth.chi2;
    }
  }
  return told;
}

CurveClass best_class(const ClassFits& fits, const Likelihood& likelihood,
                      const Evidences& evidences) {
  CurveClass best = CurveClass::Unclassified;
  double highest = -std::numeric_limits<double>::infinity();
  double lowest_chi2 = std::numeric_limits<double>::infinity();
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& fit = fits[static_cast<std::size_t>(curve_class)];
    if (!fit || fit->at_limit) {
      continue;
    }
    const double evidence = log_evidence_of(*fit, likelihood, evidences);
    if (evidence > highest ||
        (!std::isfinite(highest) && evidence == highest && fit->chi2 < lowest_chi2)) {
      highest = evidence;
      lowest_chi2 = fit->chi2;
      best = curve_class;
    }
  }
  return best;
}

ClassProbabilities probabilities_of(const Contenders& contenders, const EvidenceContext& context) {
  return probabilities_of(contenders.fits, context.arcs.smooth.chi2, context.likelihood,
                          contenders.evidences);
}

CurveClass most_probable(const ClassProbabilities& probabilities) {
  return static_cast<CurveClass>(std::max_element(probabilities.begin(), probabilities.end()) -
                                 probabilities.begin());
}

void weigh_on_reduced(std::size_t i, const EvidenceContext& context, Contenders* w) {
  Evidences& evidences = w->evidences;
  if (evidences.classes[i] && evidences.on_reduced_chi2[i] == w->coarse[i]->chi2) {
    return;
  }
  evidences.on_reduced_chi2[i] = w->coarse[i]->chi2;
  evidences.classes[i].reset();
  if ((evidences.on_reduced[i] = to_canonical(*w->coarse[i], context.reduced))) {
    evidences.classes[i] =
        evidence_of(*evidences.on_reduced[i], context.reduced, evidences.inflation, context.work);
  }
}

Contenders refine_plausible(Contenders w, const EvidenceContext& context, double margin) {
  const auto& [arcs, reduced, work, likelihood, out_of_reach] = context;
  const auto& [data, smooth, sigma_known, sigma] = arcs;
  w.evidences =
      evidences_of(w.fits, w.coarse, smooth, reduced, likelihood, std::move(w.evidences), work);
  // Where the smooth model itself misfits, neither it nor the reduced points can be trusted that
  // far.
  const double misfit_ratio = std::max(1.0, smooth.noise_ratio() * smooth.noise_ratio());
  margin *= misfit_ratio;
  // Sections that bend too much to be followed to the noise err by much the same for all classes:
  // twice as much as for the best, and kLeastError anyhow.
  double error = misfit_ratio * kLeastError;
  bool trusted = true;
  for (bool changed = true; changed && work.allows();) {
    changed = false;
    const auto b = static_cast<std::size_t>(best_class(w.fits, likelihood, w.evidences));
    auto& best = w.fits[b];
    if (best && !best->polished && w.coarse[b]->chi2 <= out_of_reach) {
      const double told = best->chi2;
      best = polished(settle(b, RivalOf::Best, reduced, &w, work), smooth, data, work);
      if (std::isfinite(best->chi2)) {
        error = std::max(error, 2.0 * (told - best->chi2));
        const double settled_chi2 = w.coarse[b]->chi2 + smooth.chi2;
        trusted = trusted && std::abs(settled_chi2 - best->chi2) <= misfit_ratio * kLeastError;
      }
      changed = true;
      continue;
    }
    const double highest = best ? log_evidence_of(*best, likelihood, w.evidences)
                                : -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < w.fits.size(); ++i) {
      auto& fit = w.fits[i];
      if (fit && !fit->weighed && !fit->at_limit &&
          !has_straight_paths(w.evidences, static_cast<CurveClass>(i)) &&
          is_plausible(*fit, highest, margin, error, likelihood, w.evidences) && work.allows()) {
        fit = weighed(settle(i, RivalOf::Other, reduced, &w, work), reduced, trusted, smooth, data,
                      work);
        changed = true;
      }
    }
  }
  take_limits(&w.fits);
  return w;
}

Contenders decided(Contenders w, const EvidenceContext& context, double margin) {
  const Arcs& arcs = context.arcs;
  const FitData& reduced = context.reduced;
  const Likelihood& likelihood = context.likelihood;
  while (true) {
    w.evidences = evidences_of(w.fits, w.coarse, arcs.smooth, reduced, likelihood,
                               std::move(w.evidences), context.work);
    w.evidences = integrated(std::move(w.evidences), w.fits, w.coarse, arcs.smooth.chi2, reduced,
                             likelihood, margin, context.work);
    const auto i = static_cast<std::size_t>(most_probable(probabilities_of(w, context)));
    auto& fit = w.fits[i];
    if (!fit || fit->polished || fit->at_limit || !context.work.allows()) {
      return w;
    }
    fit = polished(settle(i, RivalOf::Best, reduced, &w, context.work), arcs.smooth, arcs.data,
                   context.work);
    take_limits(&w.fits);
  }
}

}  // namespace palpate
