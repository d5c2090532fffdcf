#include "core/recognition/touches/strung_touches.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/samples/farthest_first.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {
namespace {

/// As many touches together that turn by no more than this are a run: a polynomial of degree 5, the
/// highest that the smooth model gives so few, follows a circle over so much to a millionth of its
/// radius.
constexpr std::size_t kRun = 12;
constexpr double kTurn = 0.6;  // rad

/// Touches that the curve for the order is sought through: more would cost time and tell no more of
/// the order.
constexpr std::size_t kSought = 48;

using Indices = std::vector<std::size_t>;

Indices lone_patches(std::span<const StoredPatch> patches) {
  Indices lone;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (patches[p].samples.size() == 1) {
      lone.push_back(p);
    }
  }
  return lone;
}

/// `most` of the touches, spread widest; all where there are no more.
Indices spread(std::span<const StoredPatch> patches, const Indices& lone, std::size_t most) {
  if (lone.size() <= most) {
    return lone;
  }
  std::vector<Vec2> places;
  for (const std::size_t p : lone) {
    places.push_back(patches[p].samples.front().position_m);
  }
  Indices chosen;
  for (const std::size_t k : farthest_first(places, most)) {
    chosen.push_back(lone[k]);
  }
  return chosen;
}

/// Parameters in their order along the curve; on a closed one from behind the largest gap.
template <typename T, typename ParameterOf>
void sort_along(const Curve& curve, std::vector<T>* things, const ParameterOf& parameter_of) {
  const auto before = [&](const T& a, const T& b) { return parameter_of(a) < parameter_of(b); };
  std::sort(things->begin(), things->end(), before);
  const double period = domain(curve).period;
  if (!(period > 0.0) || things->size() < 2) {
    return;
  }
  double widest = period + parameter_of(things->front()) - parameter_of(things->back());
  std::size_t first = 0;
  for (std::size_t i = 1; i < things->size(); ++i) {
    const double gap = parameter_of((*things)[i]) - parameter_of((*things)[i - 1]);
    if (gap > widest) {
      widest = gap;
      first = i;
    }
  }
  std::rotate(things->begin(), things->begin() + static_cast<std::ptrdiff_t>(first), things->end());
}

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

/// In straight steps. [m]
double length_of(const std::vector<Vec2>& path_m) {
  double length = 0.0;
  for (std::size_t i = 1; i < path_m.size(); ++i) {
    length += (path_m[i] - path_m[i - 1]).norm();
  }
  return length;
}

/// Length of the shortest tree through all points, by Prim's algorithm: no way through them is
/// shorter, in whatever order. [m]
double shortest_tree(const std::vector<Vec2>& points_m) {
  std::vector<double> from_tree(points_m.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> in_tree(points_m.size(), false);
  double length = 0.0;
  std::size_t last = 0;
  for (std::size_t taken = 1; taken < points_m.size(); ++taken) {
    in_tree[last] = true;
    std::size_t next = last;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      if (in_tree[i]) {
        continue;
      }
      from_tree[i] = std::min(from_tree[i], (points_m[i] - points_m[last]).norm());
      if (from_tree[i] < nearest) {
        nearest = from_tree[i];
        next = i;
      }
    }
    length += nearest;
    last = next;
  }
  return length;
}

struct PlacedCurve {
  Curve curve;
  Pose2 world_T_curve;
  double chi2 = 0.0;
  std::vector<Vec2> touches_m;  ///< in their order along it
};

/// The curve that explains the points best: by the Bayesian information criterion, each touch
/// anywhere along the curve with the same density. (Without that a needle whose two sides share
/// the points of a line would explain their noise.)
std::optional<PlacedCurve> best_of(const ClassFits& fits, const Arcs& arcs, unsigned classes) {
  const FitData& reduced = arcs.smooth.reduced;
  const auto n = static_cast<double>(reduced.points.size());
  std::optional<PlacedCurve> best;
  double lowest = std::numeric_limits<double>::infinity();
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
    if (criterion < lowest) {
      lowest = criterion;
      best = PlacedCurve{*curve, canonical->world_T_curve, chi2, std::move(ordered.points_m)};
    }
  }
  return best;
}

/// A curve to order the touches by.
std::optional<PlacedCurve> curve_through(const FitData& data, bool sigma_known, unsigned classes) {
  const Arcs arcs = smooth_arcs(data, sigma_known);
  const FitData& reduced = arcs.smooth.reduced;
  // A conic that explains the touches within their noise, and does not go back and forth between
  // them as the two sides of a needle would, has them in their order, whatever else may.
  constexpr double kDetour = 1.1;  // a step back over a tenth of the way
  std::optional<PlacedCurve> conic =
      best_of(fit_classes(reduced, nullptr, classes & ~kCubics), arcs, ~kCubics);
  const bool orders = conic && arcs.sigma_known &&
                      fits_well(conic->chi2, residual_count(reduced)) &&
                      length_of(conic->touches_m) <= kDetour * shortest_tree(conic->touches_m);
  return orders || (classes & kCubics) == 0
             ? conic
             : best_of(fit_classes(reduced, nullptr, classes), arcs, kAllClasses);
}

/// A touch's place on the curve.
struct Place {
  std::size_t patch = 0;
  double t = 0.0;
};

double angle_between(const Vec2& a, const Vec2& b) {
  return std::abs(std::atan2(cross(a, b), a.dot(b)));
}

/// By how much the curve turns between two places: over the middle, so that more than half a turn
/// shows.
double turn_between(const Curve& curve, const Place& a, const Place& b) {
  const double period = domain(curve).period;
  const double end = b.t >= a.t ? b.t : b.t + period;
  const auto tangent = [&](double t) { return derivatives(curve, t).first; };
  const Vec2 middle = tangent(0.5 * (a.t + end));
  return angle_between(tangent(a.t), middle) + angle_between(middle, tangent(end));
}

/// Which of `places`, in their order along the curve, are runs: [begin, end).
std::vector<PatchSpan> runs_of(const Curve& curve, const std::vector<Place>& places) {
  std::vector<PatchSpan> runs;
  if (places.size() < kRun) {
    return runs;
  }
  std::vector<double> turned = {0.0};  // up to each place
  for (std::size_t i = 1; i < places.size(); ++i) {
    turned.push_back(turned.back() + turn_between(curve, places[i - 1], places[i]));
  }
  for (std::size_t begin = 0; begin + kRun <= places.size(); ++begin) {
    const std::size_t end = begin + kRun;
    if (turned[end - 1] - turned[begin] > kTurn) {
      continue;
    }
    if (!runs.empty() && begin < runs.back().end) {
      runs.back().end = end;
    } else {
      runs.push_back({begin, end});
    }
  }
  return runs;
}

StoredPatch strung(std::span<const StoredPatch> patches, std::span<const Place> places) {
  StoredPatch run;
  run.context = patches[places.front().patch].context;
  run.context.material_side = MaterialSide::Unspecified;
  bool detailed = false;
  for (const Place& place : places) {
    run.samples.push_back(patches[place.patch].samples.front());
    detailed = detailed || !patches[place.patch].details.empty();
  }
  for (std::size_t i = 0; detailed && i < places.size(); ++i) {
    const std::vector<SampleDetail>& of_touch = patches[places[i].patch].details;
    run.details.push_back(of_touch.empty() ? SampleDetail{} : of_touch.front());
  }
  run.newest_m = run.samples.back().position_m;
  run.strung = true;
  return run;
}

}  // namespace

std::optional<std::vector<StoredPatch>> strung_touches(std::span<const StoredPatch> patches,
                                                       double default_sigma_m, unsigned classes) {
  const Indices lone = lone_patches(patches);
  if (lone.size() < kRun) {
    return std::nullopt;
  }
  std::vector<StoredPatch> sought;
  for (const StoredPatch& patch : patches) {
    if (patch.samples.size() > 1) {
      sought.push_back(patch);
    }
  }
  for (const std::size_t p : spread(patches, lone, kSought)) {
    sought.push_back(patches[p]);
  }
  bool sigma_known = false;
  const FitData data = make_fit_data(sought, default_sigma_m, &sigma_known);
  const auto curve = curve_through(data, sigma_known, classes);
  if (!curve) {
    return std::nullopt;
  }
  std::map<double, std::vector<Place>> of_tip;  // by its radius [m]
  for (const std::size_t p : lone) {
    const Vec2 local = curve->world_T_curve.to_local(patches[p].samples.front().position_m);
    of_tip[patches[p].context.tip_radius_m].push_back({p, foot_point(curve->curve, local).t});
  }
  std::vector<bool> taken(patches.size(), false);
  std::vector<StoredPatch> runs;
  for (auto& [tip_radius_m, places] : of_tip) {
    sort_along(curve->curve, &places, [](const Place& place) { return place.t; });
    for (const PatchSpan& run : runs_of(curve->curve, places)) {
      const auto of_run = std::span(places).subspan(run.begin, run.size());
      runs.push_back(strung(patches, of_run));
      for (const Place& place : of_run) {
        taken[place.patch] = true;
      }
    }
  }
  if (runs.empty()) {
    return std::nullopt;
  }
  std::vector<StoredPatch> result;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (!taken[p]) {
      result.push_back(patches[p]);
    }
  }
  std::move(runs.begin(), runs.end(), std::back_inserter(result));
  return result;
}

}  // namespace palpate
