#include "core/recognition/posterior/prior_modes.h"

#include <algorithm>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/modes/other_modes.h"

namespace palpate {
namespace {

/// Along which class's curve a class's modes are sought: its own, unless that is beside the
/// parabola's as improbable as if it were none. Such a fit is what the noise has made of a class
/// that could be anything: it bends otherwise than the points tell.
CurveClass path_for(CurveClass i, const ClassFits& fits, const Likelihood& likelihood, double best,
                    const Evidences& evidences) {
  constexpr auto kParabola = CurveClass::Parabola;
  if (!evidences.classes[kParabola] || !fits[kParabola]) {
    return i;
  }
  const double own = log_evidence(likelihood, evidences, *fits[i]);
  const double of_parabola = log_evidence(likelihood, evidences, *fits[kParabola]);
  return of_parabola > std::max(own + kNegligibleLogOdds, best - kUnseenLogOdds) ? kParabola : i;
}

/// Whether the data leave some of the class to the prior.
bool is_open(const ClassEvidence& evidence) {
  constexpr double kLeftToPrior = 0.1;  // of one coordinate: a deviation of a third of the prior's
  const int all = shape_coordinates(evidence.touch.curve_class) + 2;
  return evidence.determined < all - kLeftToPrior;
}

/// The class's mode that the prior leads to, where it might have more there than about its fit, and
/// so much that it is seen beside `best`.
void add_prior_mode(CurveClass i, const ClassFits& fits, const FitData& reduced,
                    const Likelihood& likelihood, double best, Evidences* evidences,
                    WorkBudget& work) {
  constexpr double kWorthOthers = 4.0;  // log odds: a fiftieth
  auto& found = evidences->classes[i];
  if (!found || found->prior_mode_sought) {
    return;
  }
  // All that a better mode can gain, about, is what the prior takes off this one.
  const double gain = -found->log_prior;
  const double told = log_evidence(likelihood, *evidences, *fits[i]);
  const double seen_from = best - kUnseenLogOdds;
  // Data that leave a cubic's shape open are such as its other arms have. A conic has none: where
  // all of it is told, nothing of its valley is left to walk along.
  const bool open = is_open(*found);
  const bool has_arms = (kCubics & class_bit(found->touch.curve_class)) != 0;
  const bool other_arms = has_arms && open && told > best - kWorthOthers;
  const bool better = (has_arms || open) && gain > kWorthAMode;
  if ((better || other_arms) && told + gain > seen_from && work.allows()) {
    const double seen_occam = found->log_occam + seen_from - told;
    const ClassEvidence& path =
        *evidences->classes[path_for(i, fits, likelihood, best, *evidences)];
    found = with_prior_mode(*found, path, points_of(*fits[i], reduced), seen_occam, work);
  }
}

using WithModeAtLimit = decltype(with_mode_at_cusp);

/// A spline has nearly as much beside one of its limits, where it is a semi-cubical parabola but
/// for its c or a parabola but for a third derivative, as that has there.
void add_mode_at(CurveClass limit, WithModeAtLimit* with_mode, const ClassFits& fits,
                 const FitData& reduced, const Likelihood& likelihood, double best,
                 Evidences* evidences, WorkBudget& work) {
  constexpr double kMissing = 2.0;  // log odds: what c, or the derivative, may cost beside none
  constexpr auto kSpline = CurveClass::CubicSpline;
  auto& spline = evidences->classes[kSpline];
  const auto& at_limit = evidences->classes[limit];
  if (!spline || !at_limit || !fits[kSpline] || !fits[limit] || !work.allows()) {
    return;
  }
  const double of_limit = log_evidence(likelihood, *evidences, *fits[limit]);
  const double of_spline = log_evidence(likelihood, *evidences, *fits[kSpline]);
  if (of_limit > std::max(of_spline + kMissing, best - kUnseenLogOdds)) {
    spline = with_mode(*std::move(spline), *at_limit, points_of(*fits[kSpline], reduced), work);
  }
}

}  // namespace

void add_prior_modes(const ClassFits& fits, const FitData& reduced, const Likelihood& likelihood,
                     double log_of_free_form, Evidences* evidences, WorkBudget& work) {
  const auto told = [&](CurveClass i) {
    return fits[i] && is_wanted(*evidences, i) ? log_evidence(likelihood, *evidences, *fits[i])
                                               : kNoEvidence;
  };
  CurveClass best = kCurveClasses.front();
  for (const CurveClass i : kCurveClasses) {
    best = told(i) > told(best) ? i : best;
  }
  const double log_of_best = told(best);
  const double highest = std::max(log_of_best, log_of_free_form);
  // Beside classes that nobody asked for it may be one of many.
  bool alone = log_of_free_form < log_of_best - kUnseenLogOdds &&
               std::all_of(kCurveClasses.begin(), kCurveClasses.end(),
                           [&](CurveClass i) { return fits[i] && is_wanted(*evidences, i); });
  for (const CurveClass i : kCurveClasses) {
    if (i != best) {
      add_prior_mode(i, fits, reduced, likelihood, highest, evidences, work);
      alone = alone && told(i) < log_of_best - kUnseenLogOdds;
    }
  }
  // Alone it has all of the probability, but what is told of its shape is where most of that is.
  const auto& found = evidences->classes[best];
  if (!alone || (found && is_open(*found))) {
    add_prior_mode(best, fits, reduced, likelihood, highest, evidences, work);
  }
  add_mode_at(CurveClass::SemiCubicalParabola, with_mode_at_cusp, fits, reduced, likelihood,
              highest, evidences, work);
  add_mode_at(CurveClass::Parabola, with_mode_at_parabola, fits, reduced, likelihood, highest,
              evidences, work);
}

}  // namespace palpate
