#include "core/recognition/weigh/fit_way.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/curves/cubic_spline.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/cusp_of_spline.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/spline_limits.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/weigh/own_directions.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

/// Whether a way leaves no more than `chi2` on all points, by its candidate or the class that was
/// the candidate before: a class with fewer parameters always leaves more.
bool is_as_near(const SideChoice& choice, CurveClass before, double chi2, const SideContext& by) {
  if (!choice.refined) {
    return false;
  }
  if (choice.refined->chi2 <= chi2) {
    return true;
  }
  const auto& fit = choice.fits[before];
  const auto refined =
      fit && before != choice.candidate
          ? refine_on_all(settled(*fit, points_of(*fit, choice.reduced), RivalOf::Other, by.work),
                          by.arcs.smooth, by.arcs.data, kOnAllEffort, by.work)
          : std::nullopt;
  return refined && refined->chi2 <= chi2;
}

/// Whether directions could be what keeps the settled candidate from the reduced points.
bool directions_may_explain(const SideChoice& choice, const FitData& touches,
                            const SmoothModel& smooth) {
  // What all points have without any directions is kept from the reduced ones by theirs.
  if (choice.refined && fits_well(choice.refined->chi2, static_cast<std::size_t>(smooth.points))) {
    return true;
  }
  const double noise = std::max(1.0, smooth.noise_ratio());
  double most = noise * noise * most_of_noise(static_cast<double>(residual_count(touches)));
  for (const FitPoint& point : touches.points) {
    const double off = tip_removal_error(point, noise) * point.inverse_sigma;
    most += off * off;
  }
  return choice.settled->chi2 <= most;
}

/// Whether directions that a curve of all points has told may still keep the candidate from them:
/// it fits all points, or it fits the reduced ones.
bool may_be_misdirected(const SideChoice& choice, const SideContext& by) {
  return fits_all(choice, by) ||
         fits_well(choice.settled->chi2,
                   residual_count(points_of(*choice.settled, choice.reduced)));
}

/// Directions that turn by less are settled: a touched point moves by a thousandth of the tip's
/// radius along the surface, and off it, if that is straight there, by half a millionth. [rad]
constexpr double kSettledTurn = 1e-3;

/// Lets the class of a fit in the same frame start from there, if it may bend sharply: wrong
/// directions make a valley of their own about the bend.
void start_at(const ClassFit& fit, WarmStart* start) {
  if (fit.curve_class == CurveClass::CubicSpline) {
    start->polynomials.cubic_spline = fit.polynomial;
  } else if (fit.curve_class == CurveClass::SemiCubicalParabola) {
    start->polynomials.semi_cubical_parabola = fit.polynomial;
  }
}

/// The class that has all points as noise lets it, whatever the reduced points with their
/// directions say of it: where a tip rolls about a cusp, these are what keeps them from it. nullopt
/// if none.
std::optional<ClassFit> best_on_all(const SideChoice& choice, const SideContext& by) {
  std::optional<ClassFit> best;
  std::optional<ClassFit> limit;  // of the cubics, what all points leave least of
  const auto keep = [&](std::optional<ClassFit> on_all) {
    if (on_all && fits_well(on_all->chi2, residual_count(by.arcs.data)) &&
        (!best || on_all->chi2 < best->chi2)) {
      best = std::move(on_all);
    }
  };
  const auto take = [&](const ClassFit& fit) {
    if (fit.at_limit || fit.chi2 > by.out_of_reach || !by.work.allows()) {
      return;
    }
    auto on_all =
        refine_on_all(settled(fit, points_of(fit, choice.reduced), RivalOf::Other, by.work),
                      by.arcs.smooth, by.arcs.data, kOnAllEffort, by.work, RivalOf::Best);
    if (on_all && on_all->on_all && is_limit_of_spline(fit.curve_class) &&
        (!limit || on_all->chi2 < limit->chi2)) {
      limit = on_all;
    }
    keep(std::move(on_all));
  };
  for (const auto& fit : choice.fits) {
    if (fit) take(*fit);
  }
  if (!best && choice.candidate == CurveClass::CubicSpline && by.work.allows()) {
    // The search may have ended where the spline was not at its cusp yet, and so that of the cusp.
    ClassFit cusp;
    cusp.curve_class = CurveClass::SemiCubicalParabola;
    cusp.own_points = choice.settled->own_points;
    cusp.polynomial =
        semi_cubical_from(*choice.settled->polynomial, points_of(*choice.settled, choice.reduced),
                          by.out_of_reach, by.work);
    cusp.chi2 = cusp.polynomial->chi2;
    take(cusp);
  }
  if (!best && limit && by.work.allows()) {
    keep(spline_from_limit(*limit, by.arcs.data, by.work));
  }
  return best;
}

/// Whether the surface points on which the classes were sought are not those of the curve found: it
/// fits along its own directions, and not along those. What else fits was then sought in vain.
bool was_sought_elsewhere(const SideChoice& choice) {
  const ClassFit& found = *choice.settled;
  const std::size_t residuals = residual_count(choice.reduced);
  if (found.own_points == nullptr || !fits_well(found.chi2, residuals)) {
    return false;
  }
  const std::span<const FitPoint> points(choice.reduced.points);
  return !fits_well(found.polynomial ? placed_on(points, *found.polynomial).chi2
                                     : placed_on(points, *found.implicit).chi2,
                    residuals);
}

/// Fits with the tips on these sides of `touches`. Where points show no direction of their own, or
/// one so swayed by noise that tips taken off along it no longer lie as all points do, directions
/// come from the curve found: one that is off by an angle puts the surface off by half its square
/// times the tip's radius, so that each round squares the error.
SideChoice fit_along(FitData touches, std::span<const int> sides, const SideContext& by,
                     std::span<const SidedStart> starts, const CurveOfCentres& centres) {
  const SmoothModel& smooth = by.arcs.smooth;
  const auto along_own = [&](ClassFits fits, const FitData& reduced, const ClassFits* before) {
    return has_lone_tips(reduced, smooth)
               ? along_own_directions(std::move(fits), reduced, sides, smooth,
                                      {centres.fits(), before}, by.work)
               : fits;
  };
  FitData reduced = on_surface(touches, sides);
  ClassFits fits =
      along_own(fit_classes_from(starts, sides, reduced, by, by.out_of_reach), reduced, nullptr);
  if (std::none_of(fits.begin(), fits.end(),
                   [&](const auto& fit) { return fit && fit->chi2 <= by.out_of_reach; })) {
    SideChoice choice;  // nothing that could be, whatever directions and evidence say
    choice.sides.assign(sides.begin(), sides.end());
    choice.fits = std::move(fits);
    choice.reduced = std::move(reduced);
    choice.evidences = by.of_paths;
    return choice;
  }
  SideChoice choice = choice_of(sides, std::move(fits), std::move(reduced), by);
  // A third of a radian leads to a millionth within three.
  constexpr int kRounds = 3;
  // Of chi-square by a round: residuals that directions leave fall with the error's square, from a
  // third of a radian to a ninth of what they were. What is not even halved they do not leave.
  constexpr double kLeastGain = 2.0;
  for (int round = 0; round < kRounds; ++round) {
    if (!choice.settled || !directions_may_explain(choice, touches, smooth) ||
        (by.directions_told && !may_be_misdirected(choice, by)) || !by.work.allows()) {
      break;
    }
    const bool swayed = choice.refined && !agrees(choice, smooth);
    // On all points distances are those of the tips' centres, whatever the directions.
    const bool of_all = swayed && choice.refined->chi2 < choice.settled->chi2 + smooth.chi2;
    // (a candidate that is no such curve on all points says nothing about the directions of all)
    const bool asks_others = !choice.refined || (swayed && !of_all && !fits_all(choice, by));
    const auto on_all = asks_others ? best_on_all(choice, by) : std::nullopt;
    const auto curve =
        on_all   ? to_canonical(*on_all, by.arcs.data)
        : of_all ? to_canonical(*choice.refined, by.arcs.data)
        : swayed || has_kept_tips(smooth)
            ? to_canonical(*choice.settled, points_of(*choice.settled, choice.reduced))
            : std::nullopt;
    if (!curve) {
      break;
    }
    const DirectionsOf which =
        swayed || on_all ? DirectionsOf::AllPoints : DirectionsOf::KeptPoints;
    const Feet feet = on_all || may_be_misdirected(choice, by) ? Feet::Touched : Feet::Nearest;
    if (set_directions(which, *curve, feet, smooth, &touches, by.work) < kSettledTurn) {
      break;
    }
    FitData nearer = on_surface(touches, sides);
    WarmStart start = warm_start_from(choice.fits, choice.reduced);
    if (of_all || on_all) {
      start_at(on_all ? *on_all : *choice.refined, &start);
    }
    const bool misled = round == 0 && was_sought_elsewhere(choice);
    ClassFits again =
        along_own(fit_classes_to(nearer, misled ? nullptr : &start, by, by.out_of_reach), nearer,
                  &choice.fits);
    const double before = least_left(choice, smooth);
    SideChoice next = choice_of(sides, std::move(again), std::move(nearer), by);
    if (!agrees(next, smooth) && disagreement(next, smooth) > disagreement(choice, smooth)) {
      break;  // worse directions than before, by what all points say
    }
    if (choice.refined &&
        !is_as_near(next, choice.candidate,
                    choice.refined->chi2 + agreement(choice.refined->chi2, smooth), by)) {
      break;  // led astray
    }
    choice = std::move(next);
    if ((of_all || on_all) && fits_all(choice, by)) {
      break;  // a curve that all points have gave the directions: they get no better
    }
    const double after = least_left(choice, smooth);
    if (noise_is_known_without_class(by.arcs, by.likelihood) && after > before / kLeastGain &&
        !fits_well(after, residual_count(by.arcs.data))) {
      break;
    }
  }
  if (const SidedStart* start = start_for(starts, sides); start && !start->modes.modes.empty()) {
    choice.evidences = by.of_paths;
    choice.evidences.earlier_modes = carried_modes(start->modes, choice.fits, choice.reduced,
                                                   by.likelihood.inflation(), by.work);
  }
  take_candidate(by, ModesOf::Prior, &choice);
  return choice;
}

/// The way with its evidence.
SideChoice judged(SideChoice choice, const SideContext& by) {
  choice.log_evidence = log_evidence_of(choice, by);
  return choice;
}

/// The touches with the directions of a curve; nullopt where these are settled already.
std::optional<FitData> turned_along(const CanonicalFit& curve, Feet feet, const FitData& touches,
                                    const SideContext& by) {
  FitData turned = touches;
  const double turn =
      set_directions(DirectionsOf::AllPoints, curve, feet, by.arcs.smooth, &turned, by.work);
  return turn < kSettledTurn ? std::nullopt : std::optional(std::move(turned));
}

/// The spline, or the cusp, with a bend at t = 0 that is no sharper than a circle of that radius,
/// as centres go about a corner; nullopt of other curves, and where the bend is none.
std::optional<CanonicalFit> rounded(const CanonicalFit& curve, double radius_m) {
  const double least = CubicSpline::c_of_bend(radius_m);
  const CurveClass curve_class = curve.shape.curve_class;
  const bool is_sharper = curve_class == CurveClass::SemiCubicalParabola ||
                          (curve_class == CurveClass::CubicSpline && curve.shape.values[2] < least);
  if (!is_sharper) {
    return std::nullopt;
  }
  CanonicalFit result = curve;
  result.shape.curve_class = CurveClass::CubicSpline;
  result.shape.values[2] = least;
  return result;
}

}  // namespace

SideChoice fit_way(const FitData& touches, std::span<const int> sides, const SideContext& by,
                   std::span<const SidedStart> starts, const CurveOfCentres& centres) {
  SideChoice choice = judged(fit_along(touches, sides, by, starts, centres), by);
  choice.along_told = by.directions_told;
  return choice;
}

SideChoice fit_way_along(const CanonicalFit& parallel, SideChoice choice, const FitData& touches,
                         const SideContext& by, const CurveOfCentres& centres) {
  auto turned =
      by.work.allows() ? turned_along(parallel, Feet::Touched, touches, by) : std::nullopt;
  if (!turned) {
    return choice;
  }
  SideChoice again = judged(fit_along(*std::move(turned), choice.sides, by, {}, centres), by);
  return again.log_evidence > choice.log_evidence ? again : choice;
}

SideChoice fit_way_again(SideChoice choice, const FitData& touches, const SideContext& by,
                         double highest, CurveOfCentres* centres) {
  const SmoothModel& smooth = by.arcs.smooth;
  const std::vector<int> sides = choice.sides;
  const auto may_gain = [&] {
    return choice.settled && !fits_all(choice, by) &&
           directions_may_explain(choice, touches, smooth) &&
           choice.log_evidence >= highest - kNegligibleLogOdds && by.work.allows();
  };
  const auto take = [&](const FitData& turned, const WarmStart* start) {
    std::vector<SidedStart> from;
    if (start != nullptr) {
      from.push_back({sides, *start});
    }
    SideChoice again = fit_along(turned, sides, by, from, *centres);
    if (again.refined && (!choice.refined || again.refined->chi2 < choice.refined->chi2)) {
      choice = judged(std::move(again), by);
    }
  };
  const auto take_along = [&](const CanonicalFit& curve, const WarmStart* start) {
    if (const auto turned = turned_along(curve, Feet::Nearest, touches, by)) {
      take(*turned, start);
    }
  };
  if (choice.along_told || !may_gain()) {
    return choice;
  }
  if (by.directions_told) {
    take(touches, nullptr);
    return choice;
  }
  if (!agrees(choice, smooth) && centres->get()) {
    take_along(*centres->get(), centres->start());
  }
  if (has_kept_tips(smooth) && may_gain() && centres->get()) {
    if (const auto curve =
            rounded(*centres->get(), largest_offset(touches.points) * touches.scale)) {
      take_along(*curve, nullptr);
    }
  }
  return choice;
}

}  // namespace palpate
