#include "core/recognition/weigh/weigh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/class_limits.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/posterior/out_of_reach.h"
#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/samples/work_limit.h"
#include "core/recognition/weigh/contenders.h"
#include "core/recognition/weigh/edges_of_part.h"
#include "core/recognition/weigh/near_parts.h"
#include "core/recognition/weigh/shared_deviations.h"
#include "core/recognition/weigh/sides.h"

namespace palpate {
namespace {

/// Of all work, kept from the search for the verdict on what it has found: the classes' refinement
/// on all points, their evidence and its integrals. What a clean ellipse's takes: half of one. More
/// would cut searches that could end: with three tenths kept, 1 of 72 full turns round a real ring
/// was RECOGNIZED as a circle, now 14 are (`bench_real --ring`).
constexpr double kShareOfVerdict = 0.5 / kMostWork;

/// log odds that keep a class from being RECOGNIZED.
double margin_of(const WeighOptions& options) {
  return std::max(log_odds(options.recognized_probability), 0.0);
}

/// Without the classes that nobody wants, those that go through points so few in any of a family of
/// ways, and, where it is they that tell the noise, those that leave nothing over for that. (A
/// class that goes through all points one way has its evidence like any other: left out, the next
/// one that misses them by little would have all.)
ClassFits testable(ClassFits fits, unsigned classes, const Arcs& arcs) {
  const int least_over = arcs.sigma_known ? 0 : 1;
  const int residuals = static_cast<int>(residual_count(arcs.data));
  for (const CurveClass curve_class : kCurveClasses) {
    const bool wanted = (classes & class_bit(curve_class)) != 0;
    if (!wanted || residuals < degrees_of_freedom(curve_class) + least_over) {
      fits[curve_class].reset();
    }
  }
  return fits;
}

/// A class placed on all points, and its chi-square there.
struct Placed {
  CanonicalFit canonical;
  double chi2 = 0.0;
};

/// Every class of one way in which the tips may lie, the plausible ones refined on all points.
/// `evidences`: what is known of them by then.
Contenders contending(ClassFits coarse, Evidences evidences, const EvidenceContext& context,
                      const WeighOptions& options) {
  const Arcs& arcs = context.arcs;
  Contenders contenders;
  contenders.coarse = testable(std::move(coarse), with_limits(options.classes), arcs);
  contenders.fits = with_inferred_chi2(contenders.coarse, arcs.smooth);
  contenders.evidences = std::move(evidences);
  return refine_plausible(std::move(contenders), context, margin_of(options));
}

/// The best class, if it was refined on all points.
std::optional<Placed> best_on_all(const Contenders& contenders, const EvidenceContext& context) {
  const CurveClass best = best_class(contenders.fits, context.likelihood, contenders.evidences);
  const auto& fit = contenders.fits[best];
  auto canonical = fit && fit->on_all ? to_canonical(*fit, context.arcs.data) : std::nullopt;
  return canonical ? std::optional(Placed{*std::move(canonical), fit->chi2}) : std::nullopt;
}

/// Shape, pose and covariance of what is not negligible, and of the best class in any case: where
/// it is out for some spikes, its residuals tell which. On all points where it was refined there,
/// otherwise on the reduced ones. `before`: a class placed already.
ByClass<std::optional<CanonicalFit>> placed_canonically(const Contenders& contenders,
                                                        const ClassProbabilities& probabilities,
                                                        const EvidenceContext& context,
                                                        std::optional<Placed> before) {
  const CurveClass best = best_class(contenders.fits, context.likelihood, contenders.evidences);
  ByClass<std::optional<CanonicalFit>> canonical;
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& fit = contenders.fits[curve_class];
    if (!fit || fit->at_limit || !std::isfinite(fit->chi2) ||
        (curve_class != best && !(probabilities[curve_class] > kNegligibleProbability))) {
      continue;
    }
    if (!fit->on_all) {
      canonical[curve_class] =
          to_canonical(*contenders.coarse[curve_class],
                       points_of(*contenders.coarse[curve_class], context.reduced));
    } else if (before && before->canonical.shape.curve_class == curve_class &&
               before->chi2 == fit->chi2) {
      canonical[curve_class] = std::move(before->canonical);
    } else {
      canonical[curve_class] = to_canonical(*fit, context.arcs.data);
    }
  }
  return canonical;
}

/// Where all ways in which the tips may lie are to be followed from; the first is the one taken.
std::vector<SidedStart> starts_of(const SidedFits& sided, const ClassFits& of_taken) {
  const SideChoice& taken = sided.choice();
  std::vector<SidedStart> starts{{taken.sides, warm_start_from(of_taken, taken.reduced)}};
  for (const SideChoice& choice : sided.choices) {
    if (&choice != &taken) {
      starts.push_back({choice.sides, warm_start_from(choice.fits, choice.reduced)});
    }
  }
  if (sided.centres) {
    starts.push_back(*sided.centres);
  }
  return starts;
}

/// log of the evidence of all models, by that of one and the share that it has.
double log_evidence_of_all(CurveClass model, double share, const Contenders& contenders,
                           const EvidenceContext& context) {
  const auto& fit = contenders.fits[model];
  const double log_of_model =
      fit ? log_evidence(context.likelihood, contenders.evidences, *fit)
          : log_evidence_of_unclassified(context.likelihood, contenders.evidences,
                                         context.arcs.smooth.chi2);
  return log_of_model - std::log(share);
}

/// As Weighing::limit_is_as_good: a line, of which every class has arcs, and the parabola, at which
/// conics and cubics end. (Where they were asked for, the posterior compares them.)
bool limit_is_as_good(CurveClass best, const Contenders& contenders,
                      const EvidenceContext& context) {
  const auto& fit = contenders.fits[best];
  const auto leaves_as_little = [&](CurveClass limit) {
    const auto& there = contenders.fits[limit];
    const int more = degrees_of_freedom(best) - degrees_of_freedom(limit);
    return there && !is_wanted(contenders.evidences, limit) && more > 0 &&
           can_be_noise(std::max(context.likelihood.counted(there->chi2) -
                                     context.likelihood.counted(fit->chi2),
                                 0.0),
                        more);
  };
  return fit && (leaves_as_little(CurveClass::Line) ||
                 (best != CurveClass::Circle && leaves_as_little(CurveClass::Parabola)));
}

/// What the stages say, gathered. `arcs` and `sided` are those that `context` is of. `best_placed`:
/// the best class, if it is placed on all points already; `stated`: the law before any was seen.
Weighing assemble_weighing(Arcs&& arcs, SidedFits&& sided, Contenders contenders,
                           const EvidenceContext& context, const ResidualExcess& seen,
                           const Likelihood& stated, std::optional<Placed> best_placed) {
  Weighing w;
  w.probabilities = probabilities_of(contenders, context);
  w.best = most_probable(w.probabilities);
  w.log_evidence = log_evidence_of_all(w.best, w.probabilities[w.best], contenders, context);
  w.margin_of_unclassified = margin_of_unclassified(contenders.fits, arcs.smooth.chi2,
                                                    context.likelihood, contenders.evidences);
  w.log_near_over_paths = contenders.evidences.log_near_over_paths;
  w.limit_is_as_good = limit_is_as_good(w.best, contenders, context);
  w.rival_share = rival_share(contenders.fits, context.likelihood, contenders.evidences);
  w.inflation = seen.noise_inflation * seen.student_inflation + stated.form_inflation();
  const auto& best = contenders.fits[w.best];
  w.counted_chi2 = misfit_of(best ? best->chi2 : arcs.smooth.chi2, context.likelihood);
  w.canonical = placed_canonically(contenders, w.probabilities, context, std::move(best_placed));
  if (best && !best->at_limit && !contenders.evidences.classes[w.best]) {
    weigh_on_reduced(w.best, context, &contenders);  // so far by straight paths alone
  }
  w.starts = starts_of(sided, contenders.coarse);
  w.starts.front().modes = kept_modes(contenders.evidences, sided.choice().reduced);
  w.best_evidence = std::move(contenders.evidences.classes[w.best]);
  w.best_on_reduced = std::move(contenders.evidences.on_reduced[w.best]);
  w.stated = stated;
  w.seen = seen;
  w.reduced = std::move(sided.choices[sided.taken].reduced);
  if (const auto& coarse = contenders.coarse[w.best]; coarse && coarse->own_points != nullptr) {
    const auto shared = std::make_shared<const FitData>(std::move(w.reduced));
    w.reduced = *coarse->own_points;
    for (auto& fit : contenders.coarse) {
      if (fit && fit->own_points == nullptr) {
        fit->own_points = shared;
      }
    }
  }
  for (const CurveClass curve_class : kCurveClasses) {
    if (!is_wanted(contenders.evidences, curve_class)) {
      contenders.fits[curve_class].reset();
      w.canonical[curve_class].reset();
    }
  }
  w.fits = std::move(contenders.fits);
  w.coarse = std::move(contenders.coarse);
  w.sides = std::move(sided.choices[sided.taken].sides);
  w.sides_margin = sided.margin;
  w.sides_against_normals = sided.against_normals();
  w.sigma = arcs.sigma;
  w.data = std::move(arcs.data);
  w.smooth = std::move(arcs.smooth);
  w.residuals.fill(residual_count(w.data));
  return w;
}

/// The arcs by less noise, where a class that leaves no more than noise leaves less than the smooth
/// model. No class can where sections follow the path: these do not, and neither they nor the
/// reduced points tell anything of the other classes. nullopt where none does.
std::optional<Arcs> bettered(Arcs* arcs, const std::optional<Placed>& best) {
  if (!best || !arcs->may_not_follow) {
    return std::nullopt;
  }
  const std::size_t residuals = residual_count(arcs->data);
  if (arcs->sigma_known) {
    const bool better = fits_well(best->chi2, residuals) &&
                        arcs->smooth.chi2 > best->chi2 + 2.0 * kNegligibleLogOdds;
    return better ? std::optional(arcs_of_stated_noise(std::move(*arcs))) : std::nullopt;
  }
  const double dof =
      static_cast<double>(residuals) - degrees_of_freedom(best->canonical.shape.curve_class);
  const double smooth_dof = arcs->smooth.dof();
  if (dof < kFewestDegreesOfNoise || smooth_dof < kFewestDegreesOfNoise) {
    return std::nullopt;
  }
  // Of its standard deviations; a false alarm, one in a thousand, costs a weighing by less noise.
  constexpr double kSeen = 3.0;
  // Log variances of normal samples have the variance 2 / dof.
  const double least = kExact / arcs->sigma;
  const double variance = std::max(best->chi2 / dof, least * least);
  const bool better = std::log(arcs->smooth.chi2 / smooth_dof / variance) >
                      kSeen * std::sqrt(2.0 / dof + 2.0 / smooth_dof);
  return better ? std::optional(arcs_of_noise(std::move(*arcs), std::sqrt(variance)))
                : std::nullopt;
}

/// Of arcs whose noise is unseen: with free paths integrated over it.
struct ArcsToWeigh {
  Arcs arcs;
  std::optional<FreeForm> over_noise = {};
  int searches = 1;  ///< for the classes, with this one
};

/// In units of the noise that free paths leave, then of the one that the best class has left.
constexpr int kMostSearches = 2;

/// The same in units of so many times the noise.
ArcsToWeigh in_units_of(ArcsToWeigh unseen, double times) {
  const double samples = likelihood_of(unseen.arcs, 0.0).samples;
  unseen.arcs = arcs_in_units_of(std::move(unseen.arcs), times);
  unseen.over_noise = over_times_the_noise(*unseen.over_noise, times, samples);
  return unseen;
}

/// Where the sections show no noise: how many times that of the arcs the class leaves that
/// explains the points best, if that is another size. By much more than the noise no class is told
/// from another, and not all their minima; what coordinates are determined is told by noise of
/// about its size. Which class is best is told by the criterion of Schwarz.
std::optional<double> times_the_noise(const ArcsToWeigh& to_weigh, const SideChoice& choice) {
  if (!to_weigh.over_noise || to_weigh.searches >= kMostSearches) {
    return std::nullopt;
  }
  const double least = kExact / to_weigh.arcs.sigma;
  const double n = static_cast<double>(residual_count(choice.reduced));
  double lowest = std::numeric_limits<double>::infinity();
  double dof = 0.0;
  double times = 1.0;
  for (const auto& fit : choice.fits) {
    if (!fit || fit->at_limit) {
      continue;
    }
    const double chi2 = std::max(fit->chi2, n * least * least);
    const double unknowns = degrees_of_freedom(fit->curve_class);
    const double criterion = n * std::log(chi2) + unknowns * std::log(n);
    if (criterion < lowest) {
      lowest = criterion;
      dof = n - unknowns;
      times = std::sqrt(chi2 / dof);
    }
  }
  // By less, what the prior leaves of a coordinate is off by a factor of 2 at most.
  constexpr double kAsGood = 2.0;
  const bool is_other = std::max(times, 1.0 / times) > kAsGood;
  return dof >= kFewestDegreesOfNoise && is_other ? std::optional(times) : std::nullopt;
}

/// Whether rounding explains all that the best class leaves.
bool are_rounded(const Arcs& arcs, const std::optional<Placed>& best) {
  if (!best || !arcs.may_be_rounding) {
    return false;
  }
  const auto left_over = static_cast<double>(residual_count(arcs.data)) -
                         degrees_of_freedom(best->canonical.shape.curve_class);
  const double rounding = arcs.data.reading_noise / arcs.sigma;
  return best->chi2 <= rounding * rounding * left_over;
}

Weighing weigh_arcs(ArcsToWeigh to_weigh, std::span<const StoredPatch> patches, WorkBudget& work,
                    const WeighOptions& options, std::span<const SidedStart> starts) {
  Arcs& arcs = to_weigh.arcs;
  const Likelihood stated = likelihood_of(arcs, options.form_deviation_m);
  work.spend(WorkKind::SectionRow, arcs.smooth.fitted);
  const unsigned sought = with_limits(options.classes);
  const auto paths_under = [&](const Likelihood& likelihood) {
    Evidences of_paths = evidences_of_paths(
        arcs.smooth, likelihood, to_weigh.over_noise ? &*to_weigh.over_noise : nullptr, work);
    of_paths.free_form.log_occam += options.log_odds_against_gross;
    of_paths.limits_only = sought & ~options.classes;
    return of_paths;
  };
  const Evidences of_paths = paths_under(stated);
  const double hopeless = out_of_reach(arcs, stated, of_paths);
  // First: they take little, and a search for classes that there are none of may take all work.
  const std::optional<Edges> edges = edges_of(arcs, reach_of_edges(arcs, stated, of_paths), work);
  std::optional<WorkBudget::Reserve> for_verdict(std::in_place, work, kShareOfVerdict);
  SidedFits sided = fit_over_sides(patches,
                                   {arcs, stated, work, of_paths, sought, hopeless,
                                    options.touched_from, edges ? &*edges : nullptr},
                                   starts);
  for_verdict.reset();
  if (work.allows()) {
    if (const auto times = times_the_noise(to_weigh, sided.choice())) {
      to_weigh = in_units_of(std::move(to_weigh), *times);
      ++to_weigh.searches;
      const std::vector<SidedStart> found = starts_of(sided, sided.choice().fits);
      return weigh_arcs(std::move(to_weigh), patches, work, options, found);
    }
  }
  const auto contenders_of_choice = [&](const EvidenceContext& context) {
    SideChoice& choice = sided.choices[sided.taken];
    const SidedStart* start = start_for(starts, choice.sides);
    if (start != nullptr && !choice.settled) {  // else it is weighed by them already
      choice.evidences.earlier_modes = carried_modes(start->modes, choice.fits, choice.reduced,
                                                     context.likelihood.inflation(), context.work);
    }
    // Where there are several they may have to be judged again.
    const bool keep = sided.choices.size() > 1;
    return contending(keep ? choice.fits : std::move(choice.fits),
                      keep ? choice.evidences : std::move(choice.evidences), context, options);
  };
  const EvidenceContext at_first{arcs, sided.choice().reduced, work, stated, hopeless};
  Contenders contenders = contenders_of_choice(at_first);
  std::optional<Placed> best_placed = best_on_all(contenders, at_first);
  if (work.allows()) {
    if (auto nearer = bettered(&arcs, best_placed)) {
      return weigh_arcs({*std::move(nearer)}, patches, work, options, starts);
    }
  }
  if (are_rounded(arcs, best_placed) && work.allows()) {
    return weigh_arcs({arcs_of_rounding(std::move(arcs))}, patches, work, options, starts);
  }
  ResidualExcess seen =
      best_placed ? residual_excess(arcs, stated, best_placed->chi2, best_placed->canonical,
                                    most_probable(probabilities_of(contenders, at_first)) ==
                                        CurveClass::Unclassified)
                  : ResidualExcess{};
  seen.correlated = seen.correlated || options.unqualified_probe;
  const Likelihood likelihood = seen.likelihood.value_or(stated);
  const Evidences of_seen_paths = seen.likelihood ? paths_under(likelihood) : Evidences{};
  const bool otherwise = seen.likelihood && rejudge_sides({arcs, likelihood, work, of_seen_paths,
                                                           sought, hopeless, options.touched_from},
                                                          &sided);
  const EvidenceContext context{arcs, sided.choice().reduced, work, likelihood, hopeless};
  if (otherwise) {
    contenders = contenders_of_choice(context);
    best_placed.reset();
  } else if (seen.likelihood) {
    contenders.evidences = of_seen_paths;
    contenders = refine_plausible(std::move(contenders), context, margin_of(options));
  } else if (seen.correlated) {
    contenders = with_shared_deviations(std::move(contenders), context, options.unqualified_probe,
                                        margin_of(options));
  }
  contenders = decided(std::move(contenders), context, margin_of(options));
  contenders = with_edges(std::move(contenders), context, edges);
  contenders = with_near_parts(std::move(contenders), context, options.near_parts,
                               options.log_near_with_gross, margin_of(options));
  const double log_of_normals = sided.choice().log_of_normals;
  Weighing weighing = assemble_weighing(std::move(arcs), std::move(sided), std::move(contenders),
                                        context, seen, stated, std::move(best_placed));
  // An edge lies as well on the other side of them all. (Ways of short strokes, which travel either
  // way, need not show it.)
  if (weighing.best == CurveClass::Line && are_open(patches, weighing.data, weighing.reduced)) {
    weighing.sides_margin = std::min(weighing.sides_margin, 2.0 * log_of_normals);
  }
  weighing.unqualified_probe = options.unqualified_probe;
  return weighing;
}

/// Where the noise is unseen: the arcs in units of what free paths along the strokes leave. By any
/// less no class would be in reach. Single touches leave nothing.
ArcsToWeigh in_units_of_paths(Arcs arcs, const WeighOptions& options, WorkBudget& work) {
  if (!is_noise_unseen(arcs)) {
    return {std::move(arcs)};
  }
  const Likelihood likelihood = likelihood_of(arcs, options.form_deviation_m);
  const FreeForm paths = free_form_over_noise(arcs.smooth, likelihood, work);
  if (!paths.log_over_noise) {  // no work was left for it
    return {std::move(arcs)};
  }
  const bool has_strokes = std::any_of(arcs.data.patches.begin(), arcs.data.patches.end(),
                                       [](const PatchSpan& patch) { return patch.size() > 1; });
  return in_units_of({std::move(arcs), paths}, has_strokes ? paths.noise : 1.0);
}

}  // namespace

Weighing weigh(FitData data, std::span<const StoredPatch> patches, WorkBudget& work,
               const WeighOptions& options, std::span<const SidedStart> starts) {
  Arcs arcs = smooth_arcs(std::move(data), {patches, options.kept_sections});
  return weigh_arcs(in_units_of_paths(std::move(arcs), options, work), patches, work, options,
                    starts);
}

}  // namespace palpate
