#include "core/recognition/touches/joined_touches.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/starts/farthest_first.h"
#include "core/recognition/fit/starts/polynomial_seeds.h"
#include "core/recognition/smooth/smooth_model.h"
#include "core/recognition/touches/ordering_curves.h"
#include "core/recognition/touches/shortest_way.h"

namespace palpate {
namespace {

/// A run has at least kRun touches in a row over which the curve turns by at most kTurn. A
/// polynomial of degree 5, the highest that the smooth model uses for so few, follows a circle over
/// that turn to a millionth of its radius.
constexpr std::size_t kRun = 12;
constexpr double kTurn = 0.6;  // rad

/// Touches that lie this far apart, in units of the noise, are in no wrong order by it.
constexpr double kLeastStep = 20.0;

/// A step of the path that turns by no more tells the direction of a touch on it: to half of that,
/// even if all of it is a corner at the touch. The rounds that remove tips (weigh/fit_way.cpp)
/// start from there; the curve of the centres, which turns about an edge with them, may know none.
/// [rad]
constexpr double kToldTurn = 1.2;

/// Touches used to fit a curve for the order: the fewest whose arms one search tells. Twice as many
/// if the noise is not stated: else straight edges may be taken for needles (bench_touches
/// --unstated --curve line).
std::size_t touches_sought(bool stated) {
  const std::size_t fewest = most_few_touches() + 1;
  return stated ? fewest : 2 * fewest;
}

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

/// `most` of the touches, spread widest, or all if there are no more.
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

/// A touch's place in the order of all.
struct Place {
  std::size_t patch = 0;
  double along = 0.0;  ///< length or parameter by which they are ordered
  /// Bounds of the path's direction there, unwrapped. [rad]
  double least_angle = 0.0, most_angle = 0.0;
  Vec2 direction = Vec2::Zero();  ///< of the path there; zero if unknown
  double turn = 0.0;              ///< as StoredPatch::turn
};

/// The curve's turn between two parameters, summed over their middle so that it may exceed half a
/// turn. [rad]
double turn_along(const Curve& curve, double a, double b) {
  const double end = b >= a ? b : b + domain(curve).period;
  const auto tangent = [&](double t) { return derivatives(curve, t).first; };
  const Vec2 middle = tangent(0.5 * (a + end));
  return std::abs(turn_between(tangent(a), middle)) + std::abs(turn_between(middle, tangent(end)));
}

/// The ranges [begin, end) of the ordered `places` that are runs.
std::vector<PatchSpan> runs_of(const std::vector<Place>& places) {
  std::vector<PatchSpan> runs;
  for (std::size_t begin = 0; begin + kRun <= places.size(); ++begin) {
    const std::size_t end = begin + kRun;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t i = begin; i < end; ++i) {
      least = std::min(least, places[i].least_angle);
      most = std::max(most, places[i].most_angle);
    }
    if (most - least > kTurn) {
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

StoredPatch run_of(std::span<const StoredPatch> patches, std::span<const Place> places) {
  StoredPatch run;
  run.context = patches[places.front().patch].context;
  run.context.material_side = MaterialSide::Unspecified;
  bool detailed = false;
  for (const Place& place : places) {
    run.samples.push_back(patches[place.patch].samples.front());
    detailed = detailed || !patches[place.patch].details.empty();
  }
  for (std::size_t i = 0; detailed && i < places.size(); ++i) {
    run.details.push_back(first_detail(patches[places[i].patch]));
  }
  run.newest_m = run.samples.back().position_m;
  run.is_joined = true;
  return run;
}

/// The runs, and the patches they replace.
struct Joined {
  std::vector<StoredPatch> runs;
  std::vector<bool> taken;
  std::vector<Place> alone;        ///< touches not in a run whose direction is known
  std::optional<WarmStart> start;  ///< of the curve that gave the order

  explicit Joined(std::size_t patches) : taken(patches, false) {}

  void add(std::span<const StoredPatch> patches, const std::vector<Place>& places) {
    for (const PatchSpan& run : runs_of(places)) {
      const auto of_run = std::span(places).subspan(run.begin, run.size());
      runs.push_back(run_of(patches, of_run));
      for (const Place& place : of_run) {
        taken[place.patch] = true;
      }
    }
    for (const Place& place : places) {
      if (!taken[place.patch] && !place.direction.isZero()) {
        alone.push_back(place);
      }
    }
  }
};

std::map<double, Indices> by_tip(std::span<const StoredPatch> patches, const Indices& lone) {
  std::map<double, Indices> of_tip;  // key: tip radius [m]
  for (const std::size_t p : lone) {
    of_tip[patches[p].context.tip_radius_m].push_back(p);
  }
  return of_tip;
}

/// Whether a smooth model must follow all bends of the runs.
enum class Bends { AreFollowed, MayBeSharp };

/// Whether a smooth path through the runs, in their order, leaves no more than the stated noise.
bool leaves_noise(std::span<const StoredPatch> runs, Bends bends, double default_sigma_m) {
  FitData data = make_fit_data(runs, default_sigma_m);
  const SmoothModel smooth = fit_smooth_model(&data, data.noise_is_stated);
  const bool followed = std::none_of(smooth.sections.begin(), smooth.sections.end(),
                                     [](const ReducedSection& section) { return section.kept; });
  return (followed || bends == Bends::MayBeSharp) && can_be_noise(smooth.chi2, smooth.dof());
}

/// Joins touches in the order of the shortest way through them, which needs no curve. nullopt if
/// that order is in doubt, or if a smooth path through the runs leaves more than the stated noise.
std::optional<Joined> joined_by_way(std::span<const StoredPatch> patches, const Indices& lone,
                                    double default_sigma_m) {
  Joined result(patches.size());
  for (const auto& [tip_radius_m, of_tip] : by_tip(patches, lone)) {
    if (of_tip.size() < kRun) {
      continue;
    }
    std::vector<Vec2> places_m;
    double sigma_m = 0.0;
    for (const std::size_t p : of_tip) {
      const StoredSample& sample = patches[p].samples.front();
      const double own_m = sigma_m_of(sample, default_sigma_m);
      if (!(own_m > 0.0)) {
        return std::nullopt;
      }
      sigma_m = std::max(sigma_m, own_m);
      places_m.push_back(sample.position_m);
    }
    const auto way = shortest_way(places_m, kLeastStep * sigma_m);
    if (!way) {
      return std::nullopt;
    }
    std::vector<Place> places;
    for (const OnWay& on_way : *way) {
      if (on_way.after_gap) {
        result.add(patches, places);
        places.clear();
      }
      const bool straight = on_way.most_angle - on_way.least_angle <= kToldTurn;
      places.push_back(
          {of_tip[on_way.place], on_way.along, on_way.least_angle, on_way.most_angle,
           straight ? Vec2(std::cos(on_way.angle), std::sin(on_way.angle)) : Vec2(0.0, 0.0),
           on_way.turn});
    }
    result.add(patches, places);
  }
  const bool holds =
      result.runs.empty() || leaves_noise(result.runs, Bends::AreFollowed, default_sigma_m);
  return holds ? std::optional(std::move(result)) : std::nullopt;
}

/// Joins touches in the order along a curve.
Joined joined_along(std::span<const StoredPatch> patches, const Indices& lone,
                    const PlacedCurve& found) {
  Joined result(patches.size());
  for (const auto& [tip_radius_m, of_tip] : by_tip(patches, lone)) {
    std::vector<Place> places;
    for (const std::size_t p : of_tip) {
      const Vec2 local = found.world_T_curve.to_local(patches[p].samples.front().position_m);
      places.push_back({p, foot_point(found.curve, local).t, 0.0, 0.0, Vec2(0.0, 0.0), 0.0});
    }
    sort_along(found.curve, &places, [](const Place& place) { return place.along; });
    for (std::size_t i = 1; i < places.size(); ++i) {
      places[i].least_angle = places[i].most_angle =
          places[i - 1].most_angle + turn_along(found.curve, places[i - 1].along, places[i].along);
    }
    result.add(patches, places);
  }
  return result;
}

/// Whether a run goes back and forth among touches that noise does not put in a wrong order.
bool goes_back_and_forth(const StoredPatch& run, double default_sigma_m) {
  std::vector<Vec2> apart;
  for (const StoredSample& sample : run.samples) {
    const double least_m = kLeastStep * sigma_m_of(sample, default_sigma_m);
    if (apart.empty() || (sample.position_m - apart.back()).norm() >= least_m) {
      apart.push_back(sample.position_m);
    }
  }
  return length_of(apart) > kDetour * shortest_tree(apart);
}

/// Joins touches in the order along the likeliest curve whose order holds; nullopt if there is
/// none. A curve that is not of the part may lead from one of its arms to another and back.
std::optional<Joined> joined_by_curve(std::span<const StoredPatch> patches, const Indices& lone,
                                      double default_sigma_m, unsigned classes, WorkBudget& work) {
  std::vector<StoredPatch> sought;
  for (const StoredPatch& patch : patches) {
    if (patch.samples.size() > 1) {
      sought.push_back(patch);
    }
  }
  const bool stated =
      default_sigma_m > 0.0 || std::all_of(patches.begin(), patches.end(), [](const auto& patch) {
        return std::all_of(patch.samples.begin(), patch.samples.end(),
                           [](const StoredSample& sample) { return sample.sigma_m > 0.0; });
      });
  for (const std::size_t p : spread(patches, lone, touches_sought(stated))) {
    sought.push_back(patches[p]);
  }
  const FitData data = make_fit_data(sought, default_sigma_m);
  std::optional<WarmStart> start;
  for (const PlacedCurve& curve : curves_through(data, classes, &start, work)) {
    work.spend(kind_of_foot(class_of(curve.curve)), lone.size());
    Joined joined = joined_along(patches, lone, curve);
    const bool holds =
        !stated || joined.runs.empty() ||
        (std::none_of(joined.runs.begin(), joined.runs.end(),
                      [&](const auto& run) { return goes_back_and_forth(run, default_sigma_m); }) &&
         leaves_noise(joined.runs, Bends::MayBeSharp, default_sigma_m));
    if (holds) {
      const bool same_points = joined.runs.empty() && sought.size() == patches.size();
      if (start && (same_points || (stated && !start->polynomials.every_seed))) {
        joined.start = std::move(start);
      }
      return joined;
    }
  }
  return std::nullopt;
}

}  // namespace

JoinedTouches joined_touches(std::span<const StoredPatch> patches, double default_sigma_m,
                             unsigned classes, WorkBudget& work) {
  const Indices lone = lone_patches(patches);
  if (lone.size() < kRun) {
    return {};
  }
  auto joined = joined_by_way(patches, lone, default_sigma_m);
  if (!joined) {
    joined = joined_by_curve(patches, lone, default_sigma_m, classes, work);
  }
  if (!joined) {
    return {};
  }
  if (joined->runs.empty()) {
    return {std::nullopt, std::move(joined->start)};
  }
  std::vector<const Place*> alone(patches.size(), nullptr);
  for (const Place& place : joined->alone) {
    alone[place.patch] = &place;
  }
  std::vector<StoredPatch> result;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (joined->taken[p]) {
      continue;
    }
    StoredPatch& patch = result.emplace_back(patches[p]);
    if (alone[p] != nullptr) {
      patch.direction = alone[p]->direction;
      patch.turn = alone[p]->turn;
    }
  }
  std::move(joined->runs.begin(), joined->runs.end(), std::back_inserter(result));
  return {std::move(result), std::move(joined->start)};
}

}  // namespace palpate
