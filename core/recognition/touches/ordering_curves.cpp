#include "core/recognition/touches/ordering_curves.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/smooth/arcs.h"
#include "core/recognition/touches/shortest_way.h"

namespace palpate {
namespace {

/// Touches in the order of their feet along the curve. [m]
struct Ordered {
  std::vector<Vec2> feet_m;
  std::vector<Vec2> points_m;
};

Ordered ordered_along(const CanonicalFit& fit, const Curve& curve, const FitData& data) {
  std::vector<std::pair<double, Vec2>> places;
  for (std::size_t i = 0; i < fit.points.size(); ++i) {
    places.emplace_back(fit.points[i].t, data.scale * data.points[i].position);
  }
  sort_along(curve, &places, [](const auto& place) { return place.first; });
  Ordered ordered;
  for (const auto& [t, point_m] : places) {
    ordered.feet_m.push_back(position(curve, t));
    ordered.points_m.push_back(point_m);
  }
  return ordered;
}

/// The curves in the order in which they explain the points by the Bayesian information criterion.
/// Each touch may lie anywhere along the curve with the same density. (Without that, a needle whose
/// two sides share the points of a line would explain their noise.)
std::vector<PlacedCurve> best_first(const ClassFits& fits, const Arcs& arcs, unsigned classes) {
  const FitData& reduced = arcs.smooth.reduced;
  const auto n = static_cast<double>(reduced.points.size());
  std::vector<std::pair<double, PlacedCurve>> curves;
  for (const auto& fit : fits) {
    const bool wanted = fit && !fit->at_limit && (classes & class_bit(fit->curve_class)) != 0;
    const auto canonical = wanted ? to_canonical(*fit, reduced) : std::nullopt;
    const auto curve = canonical ? make_curve(canonical->shape.curve_class, canonical->shape.values)
                                 : std::nullopt;
    if (!curve) {
      continue;
    }
    const double chi2 = std::max(fit->chi2, std::numeric_limits<double>::min());
    Ordered ordered = ordered_along(*canonical, *curve, reduced);
    const double criterion = (arcs.sigma_known ? chi2 : n * std::log(chi2)) +
                             degrees_of_freedom(fit->curve_class) * std::log(n) +
                             2.0 * n * std::log(length_of(ordered.feet_m));
    if (!std::isnan(criterion)) {
      curves.emplace_back(criterion, PlacedCurve{*curve, canonical->world_T_curve, chi2,
                                                 std::move(ordered.points_m)});
    }
  }
  std::stable_sort(curves.begin(), curves.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PlacedCurve> result;
  result.reserve(curves.size());
  for (auto& [criterion, curve] : curves) {
    result.push_back(std::move(curve));
  }
  return result;
}

}  // namespace

std::vector<PlacedCurve> curves_through(const FitData& data, unsigned classes,
                                        std::optional<WarmStart>* start, WorkBudget& work) {
  const Arcs arcs = smooth_arcs(data);
  const FitData& reduced = arcs.smooth.reduced;
  // A conic gives the order, whatever other classes fit, if it explains the touches within their
  // noise and does not go back and forth between them (as the two sides of a needle would).
  std::vector<PlacedCurve> conics =
      best_first(fit_classes(reduced, work, nullptr, classes & ~kCubics), arcs, ~kCubics);
  const bool orders =
      !conics.empty() && arcs.sigma_known &&
      fits_well(conics.front().chi2, residual_count(reduced)) &&
      length_of(conics.front().touches_m) <= kDetour * shortest_tree(conics.front().touches_m);
  if (orders || (classes & kCubics) == 0) {
    return conics;
  }
  const ClassFits fits = fit_classes(reduced, work, nullptr, classes);
  *start = warm_start_from(fits, reduced);
  return best_first(fits, arcs, kAllClasses);
}

}  // namespace palpate
