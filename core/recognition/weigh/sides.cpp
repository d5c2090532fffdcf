#include "core/recognition/weigh/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/weigh/contenders.h"

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

}  // namespace

SidedFits fit_over_sides(std::span<const StoredPatch> patches, const Arcs& arcs,
                         const Likelihood& likelihood, unsigned classes,
                         std::span<const SidedStart> starts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Tips that touch a part from within a bend are rare: probes come from outside.
  constexpr double kInsideProbability = 0.01;
  const auto& [data, smooth, sigma_known, sigma] = arcs;
  const auto ways = possible_sides(patches, smooth.reduced);
  if (ways.size() == 1) {
    FitData reduced = on_surface(smooth.reduced, ways.front());
    ClassFits fits = fit_classes_from(starts, ways.front(), reduced, classes);
    return {std::move(fits), std::move(reduced), ways.front(), kInfinity, {}};
  }
  const double log_price_of_inside = log_odds(1.0 - kInsideProbability);
  SidedFits best;
  std::vector<SidedStart> others;
  double highest = -kInfinity;
  double second = -kInfinity;
  for (const std::vector<int>& sides : ways) {
    FitData reduced = on_surface(smooth.reduced, sides);
    ClassFits fits = fit_classes_from(starts, sides, reduced, classes);
    const ClassFits told = as_told(fits, smooth);
    const Evidences evidences = evidences_of(told, fits, smooth, reduced, likelihood);
    const CurveClass candidate = best_class(told, likelihood, evidences);
    const auto& fit = fits[static_cast<std::size_t>(candidate)];
    const auto refined =
        fit ? refine_on_all(settled(*fit, reduced, RivalOf::Best), smooth, data) : std::nullopt;
    const bool first = &sides == &ways.front();
    // A line has no bend to be outside of.
    const double price = first || candidate == CurveClass::Line ? 0.0 : log_price_of_inside;
    const double evidence =
        refined ? log_evidence(likelihood, evidences, candidate, refined->chi2) - price
                : -kInfinity;
    if (first || evidence > highest) {
      if (!first) {
        others.push_back({best.sides, warm_start_from(best.fits, best.reduced)});
      }
      second = highest;
      highest = evidence;
      best = {std::move(fits), std::move(reduced), sides, 0.0, {}};
    } else {
      others.push_back({sides, warm_start_from(fits, reduced)});
      second = std::max(second, evidence);
    }
  }
  best.others = std::move(others);
  best.margin = std::isfinite(second) ? highest - second : kInfinity;
  return best;
}

}  // namespace palpate
