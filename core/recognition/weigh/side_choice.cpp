#include "core/recognition/weigh/side_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/recognition/coherent/coherent_evidence.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/weigh/contenders.h"
#include "core/recognition/weigh/probable_cusp.h"

namespace palpate {
namespace {

/// Whether the tips' centres lie on these sides of their travel, as a curve fitted to all of them
/// has it.
bool lie_so(std::span<const int> sides, const ClassFit& on_all, const FitData& data) {
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    double to_the_left = 0.0;
    for (std::size_t i = data.patches[p].begin; i + 1 < data.patches[p].end; ++i) {
      const Vec2 centre = data.points[i].position;
      to_the_left += left_of(data.points[i + 1].position - centre).dot(centre - foot_of(on_all, i));
    }
    if (sides[p] * to_the_left < 0.0) {
      return false;
    }
  }
  return true;
}

/// The candidate as all points see it: refined on them, or as it is where they tell what the
/// reduced points do.
std::optional<ClassFit> seen_by_all(const ClassFit& settled, const FitData& reduced,
                                    const SideContext& by) {
  const SmoothModel& smooth = by.arcs.smooth;
  auto fit = where_all_agree(settled, reduced, smooth, by.arcs.data, by.work);
  if (!fit && by.work.allows()) {
    fit = refine_on_all(settled, smooth, by.arcs.data, kOnAllEffort, by.work);
  }
  return fit;
}

/// What the reduced points tell of all classes, and their evidences with it.
ClassFits told_by(const SideContext& by, ModesOf modes, SideChoice* choice) {
  const SmoothModel& smooth = by.arcs.smooth;
  ClassFits told = with_inferred_chi2(choice->fits, smooth);
  choice->evidences = evidences_of(told, choice->fits, smooth, choice->reduced, by.likelihood,
                                   std::move(choice->evidences), by.work, modes);
  return told;
}

/// As settle_candidate(), of those told.
bool settle_best(const ClassFits& told, const SideContext& by, SideChoice* choice) {
  const CurveClass before = choice->candidate;
  choice->candidate = best_class(told, by.likelihood, choice->evidences);
  if (choice->candidate == before) {
    return false;
  }
  choice->settled.reset();
  choice->refined.reset();
  if (const auto& fit = choice->fits[choice->candidate]) {
    const bool may_win = !noise_is_known_without_class(by.arcs, by.likelihood) ||
                         fits_well(fit->chi2, residual_count(choice->reduced));
    choice->settled = settled(*fit, points_of(*fit, choice->reduced),
                              may_win ? RivalOf::Best : RivalOf::Other, by.work);
  }
  return true;
}

/// The candidate on all points, if it is such a curve there.
void refine_settled(const SideContext& by, SideChoice* choice) {
  if (!choice->settled) {
    return;
  }
  choice->refined = seen_by_all(*choice->settled, points_of(*choice->settled, choice->reduced), by);
  if (choice->refined && choice->refined->on_all &&
      !lie_so(choice->sides, *choice->refined, by.arcs.data)) {
    choice->refined.reset();
  }
}

}  // namespace

ClassFits fit_classes_to(const FitData& reduced, const WarmStart* start, const SideContext& by,
                         double out_of_reach) {
  return with_probable_cusp(fit_classes(reduced, by.work, start, by.classes, out_of_reach), reduced,
                            by.likelihood.inflation(), by.work);
}

ClassFits fit_classes_from(std::span<const SidedStart> starts, std::span<const int> sides,
                           const FitData& reduced, const SideContext& by, double out_of_reach) {
  const SidedStart* start = start_for(starts, sides);
  return fit_classes_to(reduced, start != nullptr ? &start->start : nullptr, by, out_of_reach);
}

bool settle_candidate(const SideContext& by, ModesOf modes, SideChoice* choice) {
  return settle_best(told_by(by, modes, choice), by, choice);
}

void take_candidate(const SideContext& by, ModesOf modes, SideChoice* choice) {
  ClassFits told = told_by(by, modes, choice);
  if (!settle_best(told, by, choice)) {
    return;
  }
  refine_settled(by, choice);
  // The reduced points may tell a class that all points do not have, as beside a cusp a spline that
  // goes round it: then the next of those that both have.
  const auto fits_reduced = [&] {
    return choice->settled && fits_well(choice->settled->chi2, residual_count(choice->reduced));
  };
  if (fits_all(*choice, by) || !fits_reduced()) {
    return;
  }
  const CurveClass first = choice->candidate;
  std::optional<ClassFit> settled_first = choice->settled;
  std::optional<ClassFit> refined_first = choice->refined;
  while (!fits_all(*choice, by) && fits_reduced() && by.work.allows()) {
    told[choice->candidate].reset();
    settle_best(told, by, choice);
    refine_settled(by, choice);
  }
  if (!fits_all(*choice, by)) {
    choice->candidate = first;
    choice->settled = std::move(settled_first);
    choice->refined = std::move(refined_first);
  }
}

SideChoice choice_of(std::span<const int> sides, ClassFits fits, FitData reduced,
                     const SideContext& by) {
  SideChoice choice;
  choice.sides.assign(sides.begin(), sides.end());
  choice.fits = std::move(fits);
  choice.reduced = std::move(reduced);
  choice.evidences = by.of_paths;
  take_candidate(by, ModesOf::Fit, &choice);
  return choice;
}

double agreement(double chi2, const SmoothModel& smooth) {
  constexpr double kTenfold = 4.6;  // 2 ln 10
  return kTenfold * std::max(1.0, chi2 / smooth.points);
}

double disagreement(const SideChoice& choice, const SmoothModel& smooth) {
  return choice.refined ? std::abs(choice.settled->chi2 + smooth.chi2 - choice.refined->chi2)
                        : std::numeric_limits<double>::infinity();
}

bool agrees(const SideChoice& choice, const SmoothModel& smooth) {
  return choice.refined && disagreement(choice, smooth) <= agreement(choice.refined->chi2, smooth);
}

bool fits_all(const SideChoice& choice, const SideContext& by) {
  return choice.refined && fits_well(choice.refined->chi2, residual_count(by.arcs.data));
}

double least_left(const SideChoice& choice, const SmoothModel& smooth) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double on_reduced = choice.settled ? choice.settled->chi2 + smooth.chi2 : kNone;
  return choice.refined ? std::min(on_reduced, choice.refined->chi2) : on_reduced;
}

double log_evidence_of(const SideChoice& choice, const SideContext& by) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  if (!choice.refined) {
    return kNone;
  }
  const FitData& reduced = points_of(*choice.settled, choice.reduced);
  const auto placed = to_canonical(*choice.settled, reduced);
  if (!placed) {
    return kNone;
  }
  auto evidence = choice.evidences.classes[choice.candidate];
  if (!evidence) {
    evidence = evidence_of(*placed, reduced, by.likelihood.inflation(), by.work);
  }
  return evidence ? log_coherent_evidence(by.likelihood, *evidence, *placed, reduced, by.arcs.sigma,
                                          static_cast<double>(by.arcs.data.points.size()),
                                          choice.refined->chi2, by.arcs.smooth.chi2, by.work)
                  : kNone;
}

}  // namespace palpate
