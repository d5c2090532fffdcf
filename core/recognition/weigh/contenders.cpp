#include "core/recognition/weigh/contenders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/cusp_of_spline.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/spline_limits.h"
#include "core/recognition/posterior/class_limits.h"
#include "core/recognition/posterior/laplace_evidences.h"

namespace palpate {
namespace {

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
  fit.chi2_of_all = true;
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
ClassFit with_chi2_of_all(const ClassFit& coarse, const FitData& reduced, bool trusted,
                          const SmoothModel& smooth, const FitData& data, WorkBudget& work) {
  auto fit = trusted ? where_all_agree(coarse, points_of(coarse, reduced), smooth, data, work)
                     : std::nullopt;
  if (!fit) {
    fit = refine_on_all(coarse, smooth, data, kOnAllEffort, work);
  }
  return fit.value_or(out(coarse));
}

/// Takes contenders->coarse of a class to its optimum on the reduced points, unless it is there, or
/// leaves more than any noise after all that a search has tried: that is no curve of the class.
const ClassFit& settle(CurveClass i, RivalOf rival, const FitData& reduced, Contenders* contenders,
                       WorkBudget& work) {
  const FitData& points = points_of(*contenders->coarse[i], reduced);
  if (contenders->coarse[i]->chi2 <= most_chi2_of_noise(points.points) &&
      (!contenders->fits[i]->chi2_of_all ||
       (rival == RivalOf::Best && contenders->coarse[i]->rival))) {
    contenders->coarse[i] = settled(*contenders->coarse[i], points, rival, work);
  }
  return *contenders->coarse[i];
}

/// By how much more chi-square a semi-cubical parabola leaves than a spline that is near one: by
/// its c, which that has at 0.
double chi2_of_c(const ClassFit& spline, const FitData& data) {
  constexpr Eigen::Index kC = 2;  // of [a, b, c, ...]
  const auto canonical = to_canonical(spline, data);
  if (!canonical) {
    return 0.0;
  }
  const double c = canonical->shape.values[kC];
  return c * c / canonical->covariance(kC, kC);
}

/// The semi-cubical parabola next to the best spline, where its own fit leaves more: no polynomial
/// of a section leads round a cusp that was not seen as one, and of a stroke that ends behind it
/// the feet of the last samples may be on the arm that it came from.
void seek_cusp(CurveClass i, const EvidenceContext& context, Contenders* contenders) {
  constexpr auto kSemiCubical = CurveClass::SemiCubicalParabola;
  const auto& spline = contenders->fits[CurveClass::CubicSpline];
  auto& fit = contenders->fits[kSemiCubical];
  auto& coarse = contenders->coarse[kSemiCubical];
  if (i != CurveClass::CubicSpline || !fit || !coarse || !std::isfinite(spline->chi2) ||
      !context.work.allows()) {
    return;
  }
  // Less than its own fit leaves, and not so much that it is out.
  const double most = std::min(fit->chi2 - spline->chi2 - kLeastError, 2.0 * kNegligibleLogOdds);
  if (most <= 0.0 || chi2_of_c(*spline, context.arcs.data) > most) {
    return;
  }
  auto found = cusp_of_spline(*spline, context.arcs.data, context.work);
  if (!found || !(found->chi2 < fit->chi2)) {
    return;
  }
  found->own_points = spline->own_points;
  const FitData& points = points_of(*found, context.reduced);
  coarse = settled(placed_on_reduced(*found, points, context.work), points, RivalOf::Other,
                   context.work);
  fit = std::move(found);
}

/// Takes contenders->coarse of a spline to the optimum that all points have come to, where that is
/// another than the reduced points' own: about a sharp bend these may fit a curve that all points
/// do not. Evidence is counted from chi-square at the optimum. From one valley's, with what all
/// points leave in another, the difference of the two would count twice.
void follow_all_points(CurveClass i, const EvidenceContext& context, Contenders* contenders) {
  const ClassFit& fit = *contenders->fits[i];
  ClassFit& coarse = *contenders->coarse[i];
  const auto off = [&](const ClassFit& told) {
    return std::abs(told.chi2 + context.arcs.smooth.chi2 - fit.chi2);
  };
  if (i != CurveClass::CubicSpline || !fit.on_all || !std::isfinite(fit.chi2) ||
      !(off(coarse) > kLeastError) || !context.work.allows()) {
    return;
  }
  const FitData& points = points_of(coarse, context.reduced);
  ClassFit there = placed_on_reduced(fit, points, context.work);
  there.rival.reset();
  there.own_points = coarse.own_points;
  there = settled(there, points, RivalOf::Best, context.work);
  if (!(off(there) < off(coarse) - kLeastError)) {
    return;
  }
  coarse = std::move(there);
  auto& evidence = contenders->evidences.classes[i];
  const auto before = std::exchange(evidence, std::nullopt);
  weigh_on_reduced(i, context, contenders);
  if (!before || !before->prior_mode_sought) {
    return;
  }
  // A mode that leaves less of the reduced points is of the valley that all points have left.
  const double here = coarse.chi2 / context.likelihood.inflation();
  const double of_mode = before->nodes[before->mode].curve.chi2;
  if (!evidence) {
    evidence = counted_from(std::min(here, of_mode), *before);
  } else if (of_mode >= here - kLeastError) {
    evidence = at_better_mode(*std::move(evidence), *before);
  }
}

/// A spline can be no worse than its limits: where all points leave less of one than of the spline
/// that the reduced points led to, it is sought from there. If these tell of a far better one that
/// all points were not led to, what is found is not known to be the best.
void seek_spline_from_limits(const EvidenceContext& context, Contenders* contenders) {
  constexpr auto kSpline = CurveClass::CubicSpline;
  constexpr double kTenfold = 4.6;  // of chi-square: odds change tenfold by 2 ln 10
  auto& spline = contenders->fits[kSpline];
  const auto& coarse = contenders->coarse[kSpline];
  if (!spline || !spline->chi2_of_all || !coarse) {
    return;
  }
  const double most = coarse->chi2 + context.arcs.smooth.chi2 + kTenfold;
  bool found_any = false;
  for (const CurveClass i : kLimitsOfSpline) {
    const auto& limit = contenders->fits[i];
    if (!limit || !limit->on_all || spline->chi2 <= limit->chi2 + kWorseThanLimit ||
        !context.work.allows()) {
      continue;
    }
    auto found = spline_from_limit(*limit, context.arcs.data, context.work);
    if (found && found->chi2 < spline->chi2 && found->chi2 <= most) {
      found->own_points = coarse->own_points;
      spline = std::move(found);
      found_any = true;
    }
  }
  if (found_any) {
    follow_all_points(kSpline, context, contenders);
  }
}

/// A search may end so far from a class's optimum that there is no evidence to be counted from it:
/// where its chi-square alone does not put it below `least`, it is taken there. (A spline goes with
/// its rival, as the best class only.)
void weigh_at_optimum(CurveClass i, double least, const EvidenceContext& context,
                      Contenders* contenders) {
  ClassFit& told = *contenders->fits[i];
  if (i == CurveClass::CubicSpline || contenders->evidences.classes[i] ||
      contenders->coarse[i]->chi2 > context.out_of_reach ||
      !(context.likelihood.log_evidence(told.chi2, 0.0, 0.0) > least) || !context.work.allows()) {
    return;
  }
  const ClassFit& at_optimum = settle(i, RivalOf::Other, context.reduced, contenders, context.work);
  told.chi2 = at_optimum.chi2 + context.arcs.smooth.chi2;
  weigh_on_reduced(i, context, contenders);
}

/// Classes that end at their limit, or worse than it, are what it is.
void take_limits(ClassFits* fits) {
  for (const CurveClass curve_class : kClassesWithLimit) {
    auto& fit = (*fits)[curve_class];
    const auto limit = limit_of(curve_class, *fits);
    if (!fit || !limit) {
      continue;
    }
    const ClassFit& there = *(*fits)[*limit];
    if (fit->at_limit || !(fit->chi2 <= there.chi2 + kWorseThanLimit)) {
      fit = there;
      fit->curve_class = curve_class;
      fit->at_limit = true;
    }
  }
}

}  // namespace

double chi2_without_deviation(const Contenders& contenders, const EvidenceContext& context,
                              CurveClass curve_class) {
  return std::max(contenders.coarse[curve_class]->chi2 + context.arcs.smooth.chi2,
                  contenders.fits[curve_class]->chi2);
}

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
    const auto& fit = fits[curve_class];
    if (!fit || fit->at_limit || !is_wanted(evidences, curve_class)) {
      continue;
    }
    const double evidence = log_evidence(likelihood, evidences, *fit);
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

void weigh_on_reduced(CurveClass i, const EvidenceContext& context, Contenders* contenders) {
  Evidences& evidences = contenders->evidences;
  if (!evidences.classes[i] || evidences.on_reduced_chi2[i] != contenders->coarse[i]->chi2) {
    add_laplace_evidence(*contenders->coarse[i], context.reduced, &evidences, context.work);
  }
}

Contenders refine_plausible(Contenders contenders, const EvidenceContext& context, double margin) {
  const FitData& data = context.arcs.data;
  const SmoothModel& smooth = context.arcs.smooth;
  const FitData& reduced = context.reduced;
  const Likelihood& likelihood = context.likelihood;
  WorkBudget& work = context.work;
  contenders.evidences = evidences_of(contenders.fits, contenders.coarse, smooth, reduced,
                                      likelihood, std::move(contenders.evidences), work);
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
    const CurveClass b = best_class(contenders.fits, likelihood, contenders.evidences);
    auto& best = contenders.fits[b];
    if (best && !best->polished && contenders.coarse[b]->chi2 <= context.out_of_reach) {
      const double told = best->chi2;
      best = polished(settle(b, RivalOf::Best, reduced, &contenders, work), smooth, data, work);
      if (std::isfinite(best->chi2)) {
        error = std::max(error, 2.0 * (told - best->chi2));
        const double settled_chi2 = contenders.coarse[b]->chi2 + smooth.chi2;
        trusted = trusted && std::abs(settled_chi2 - best->chi2) <= misfit_ratio * kLeastError;
        seek_cusp(b, context, &contenders);
        follow_all_points(b, context, &contenders);
      }
      changed = true;
      continue;
    }
    const double highest = best ? log_evidence(likelihood, contenders.evidences, *best)
                                : -std::numeric_limits<double>::infinity();
    const bool best_fits = best && fits_well(best->chi2, residual_count(data));
    for (const CurveClass i : kCurveClasses) {
      auto& fit = contenders.fits[i];
      if (!fit || fit->chi2_of_all || fit->at_limit ||
          has_straight_paths(contenders.evidences, i)) {
        continue;
      }
      if (!best_fits) {  // what the reduced points told to be the best is none
        weigh_at_optimum(i, highest - margin, context, &contenders);
      }
      if (is_plausible(*fit, highest, margin, error, likelihood, contenders.evidences) &&
          work.allows()) {
        fit = with_chi2_of_all(settle(i, RivalOf::Other, reduced, &contenders, work), reduced,
                               trusted, smooth, data, work);
        follow_all_points(i, context, &contenders);
        changed = true;
      }
    }
  }
  seek_spline_from_limits(context, &contenders);
  take_limits(&contenders.fits);
  return contenders;
}

Contenders decided(Contenders contenders, const EvidenceContext& context, double margin) {
  const Arcs& arcs = context.arcs;
  const FitData& reduced = context.reduced;
  const Likelihood& likelihood = context.likelihood;
  while (true) {
    contenders.evidences = evidences_of(contenders.fits, contenders.coarse, arcs.smooth, reduced,
                                        likelihood, std::move(contenders.evidences), context.work);
    contenders.evidences =
        integrated(std::move(contenders.evidences), contenders.fits, contenders.coarse,
                   arcs.smooth.chi2, reduced, likelihood, margin, context.work);
    const CurveClass i = most_probable(probabilities_of(contenders, context));
    auto& fit = contenders.fits[i];
    if (!fit || fit->polished || fit->at_limit || !context.work.allows()) {
      return contenders;
    }
    fit = polished(settle(i, RivalOf::Best, reduced, &contenders, context.work), arcs.smooth,
                   arcs.data, context.work);
    seek_cusp(i, context, &contenders);
    follow_all_points(i, context, &contenders);
    take_limits(&contenders.fits);
  }
}

}  // namespace palpate
