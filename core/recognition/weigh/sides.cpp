#include "core/recognition/weigh/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/weigh/contenders.h"
#include "core/recognition/weigh/kept_directions.h"

namespace palpate {
namespace {

/// The classes followed from where they were with the tips on these sides, or sought.
ClassFits fit_classes_from(std::span<const SidedStart> starts, std::span<const int> sides,
                           const FitData& reduced, unsigned classes) {
  const auto start = std::find_if(starts.begin(), starts.end(), [&](const SidedStart& s) {
    return std::equal(s.sides.begin(), s.sides.end(), sides.begin(), sides.end());
  });
  if (start == starts.end()) {
    return fit_classes(reduced, nullptr, classes);
  }
  const PolynomialFits carried = carried_to(start->start, reduced);
  return fit_classes(reduced, &carried, classes);
}

/// The classes fitted for one way in which the tips may lie.
struct Way {
  ClassFits fits;
  FitData reduced;  ///< surface points
  CurveClass candidate = CurveClass::Unclassified;
  std::optional<ClassFit> settled;  ///< the candidate at its optimum on the reduced points
  Evidences evidences;
};

Way way_of(ClassFits fits, FitData reduced, const SmoothModel& smooth,
           const Likelihood& likelihood) {
  Way way{std::move(fits), std::move(reduced), CurveClass::Unclassified, std::nullopt, {}};
  const ClassFits told = as_told(way.fits, smooth);
  way.evidences = evidences_of(told, way.fits, smooth, way.reduced, likelihood);
  way.candidate = best_class(told, likelihood, way.evidences);
  if (const auto& fit = way.fits[static_cast<std::size_t>(way.candidate)]) {
    way.settled = settled(*fit, way.reduced, RivalOf::Best);
  }
  return way;
}

/// Fits with the tips on these sides of `touches`, whose kept points' directions come from the
/// curve found: a direction that is off by an angle puts the surface off by half its square times
/// the tip's radius, so that each round squares the error.
Way fit_way(FitData touches, std::span<const int> sides, const SmoothModel& smooth,
            const Likelihood& likelihood, unsigned classes, std::span<const SidedStart> starts) {
  FitData reduced = on_surface(touches, sides);
  ClassFits fits = fit_classes_from(starts, sides, reduced, classes);
  Way way = way_of(std::move(fits), std::move(reduced), smooth, likelihood);
  if (!has_kept_tips(smooth)) {
    return way;
  }
  constexpr int kRounds = 3;  // an angle of a tenth becomes one of 1e-8
  for (int round = 0; round < kRounds; ++round) {
    const auto curve = way.settled ? to_canonical(*way.settled, way.reduced) : std::nullopt;
    if (!curve) {
      break;
    }
    set_kept_directions(*curve, smooth, &touches);
    FitData nearer = on_surface(touches, sides);
    const PolynomialFits carried = carried_to(warm_start_from(way.fits, way.reduced), nearer);
    ClassFits again = fit_classes(nearer, &carried, classes);
    way = way_of(std::move(again), std::move(nearer), smooth, likelihood);
  }
  return way;
}

/// The reduced points with directions for those that show none: from the curve that fits the tips'
/// centres best. `bend`: of touches alone in their patch.
FitData with_directions(const SmoothModel& smooth, const Likelihood& likelihood, unsigned classes,
                        double* bend) {
  FitData touches = smooth.reduced;
  const Way centres = way_of(fit_classes(touches, nullptr, classes), touches, smooth, likelihood);
  if (const auto curve = centres.settled ? to_canonical(*centres.settled, touches) : std::nullopt) {
    *bend = set_kept_directions(*curve, smooth, &touches).sum;
  }
  return touches;
}

}  // namespace

SidedFits fit_over_sides(std::span<const StoredPatch> patches, const Arcs& arcs,
                         const Likelihood& likelihood, unsigned classes,
                         std::span<const SidedStart> starts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Tips that touch a part from within a bend are rare: probes come from outside.
  constexpr double kInsideProbability = 0.01;
  const auto& [data, smooth, sigma_known, sigma] = arcs;
  double lone_bend = 0.0;
  const FitData touches = has_kept_tips(smooth)
                              ? with_directions(smooth, likelihood, classes, &lone_bend)
                              : smooth.reduced;
  const auto ways = possible_sides(patches, touches, lone_bend);
  if (ways.size() == 1 && !has_kept_tips(smooth)) {
    FitData reduced = on_surface(touches, ways.front());
    ClassFits fits = fit_classes_from(starts, ways.front(), reduced, classes);
    return {std::move(fits), std::move(reduced), ways.front(), kInfinity, {}};
  }
  if (ways.size() == 1) {
    Way way = fit_way(touches, ways.front(), smooth, likelihood, classes, starts);
    return {std::move(way.fits), std::move(way.reduced), ways.front(), kInfinity, {}};
  }
  const double log_price_of_inside = log_odds(1.0 - kInsideProbability);
  SidedFits best;
  std::vector<SidedStart> others;
  double highest = -kInfinity;
  double second = -kInfinity;
  for (const std::vector<int>& sides : ways) {
    Way way = fit_way(touches, sides, smooth, likelihood, classes, starts);
    const auto refined = way.settled ? refine_on_all(*way.settled, smooth, data) : std::nullopt;
    const bool first = &sides == &ways.front();
    // A line has no bend to be outside of.
    const double price = first || way.candidate == CurveClass::Line ? 0.0 : log_price_of_inside;
    const double evidence =
        refined ? log_evidence(likelihood, way.evidences, way.candidate, refined->chi2) - price
                : -kInfinity;
    if (first || evidence > highest) {
      if (!first) {
        others.push_back({best.sides, warm_start_from(best.fits, best.reduced)});
      }
      second = highest;
      highest = evidence;
      best = {std::move(way.fits), std::move(way.reduced), sides, 0.0, {}};
    } else {
      others.push_back({sides, warm_start_from(way.fits, way.reduced)});
      second = std::max(second, evidence);
    }
  }
  best.others = std::move(others);
  best.margin = std::isfinite(second) ? highest - second : kInfinity;
  return best;
}

}  // namespace palpate
