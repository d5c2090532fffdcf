#include "core/recognition/given/given_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/recognition/given/descent.h"
#include "core/recognition/given/foot_parameter.h"
#include "core/recognition/given/given_starts.h"

namespace palpate {
namespace {

/// At most `most` points, evenly spaced by index: enough to judge a start.
std::vector<WeighedPoint<double>> some(std::span<const WeighedPoint<double>> all,
                                       std::size_t most) {
  const std::size_t stride = (all.size() + most - 1) / most;
  std::vector<WeighedPoint<double>> points;
  for (std::size_t i = 0; i < all.size(); i += stride) {
    points.push_back(all[i]);
  }
  return points;
}

/// Sets every foot to the nearest point of the whole curve. False if the shape is outside the
/// class.
bool seat_globally(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points) {
  const auto curve = curve_of(*placed);
  if (!curve) {
    return false;
  }
  placed->feet.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlaneVector<double> p = placed->to_curve(points[i].position);
    const FootPoint foot = foot_point(*curve, {p.x, p.y});
    if (!std::isfinite(foot.distance)) {
      return false;
    }
    placed->feet[i] = parameter_at(placed->curve_class, foot.t);
  }
  return true;
}

/// Settled ones come first, then the lower cost.
bool is_better(const GivenCandidate& u, const GivenCandidate& v) {
  return u.settled != v.settled ? u.settled : u.cost < v.cost;
}

void descend_on(std::span<const WeighedPoint<double>> points, const DescentEffort& effort,
                GivenCandidate* candidate) {
  const auto seat = [&](PlacedCurve<double>* trial) { return seat_globally(trial, points); };
  candidate->settled = false;
  candidate->cost = std::numeric_limits<double>::infinity();
  if (!seat(&candidate->curve)) {
    return;
  }
  const auto descent = descend(&candidate->curve, points, effort, seat);
  candidate->cost = descent.squares.cost;
  candidate->settled = descent.settled;
}

/// The points in double precision, with tip centres on that side of the curve.
std::vector<WeighedPoint<double>> on_side(std::span<const WeighedPoint<DoubleDouble>> exact,
                                          int side) {
  std::vector<WeighedPoint<double>> points;
  points.reserve(exact.size());
  for (const WeighedPoint<DoubleDouble>& point : exact) {
    points.push_back({as_double(point.position), to_double(point.weight),
                      side * to_double(point.offset), as_double(point.normal),
                      to_double(point.normal_weight)});
  }
  return points;
}

/// Starts from the points. If normals are measured, also from two extra places per point, on its
/// tangent to either side: so there are starts for fewer points than the class has unknowns.
std::vector<GivenStart> starts_of(CurveClass curve_class, const LocalPoints& local) {
  std::vector<GivenStart> starts = given_starts(curve_class, local.rough);
  if (local.normals == 0) {
    return starts;
  }
  // Of the points' extent, which is about 1. So near, a curve has hardly left its tangent.
  constexpr double kAside = 0.1;
  std::vector<Vec2> more = local.rough;
  for (const WeighedPoint<DoubleDouble>& point : local.exact) {
    if (to_double(point.normal_weight) > 0.0) {
      const PlaneVector<double> n = as_double(point.normal);
      const PlaneVector<double> p = as_double(point.position);
      more.emplace_back(p.x - kAside * n.y, p.y + kAside * n.x);
      more.emplace_back(p.x + kAside * n.y, p.y - kAside * n.x);
    }
  }
  const std::vector<GivenStart> by_normals = given_starts(curve_class, more);
  starts.insert(starts.end(), by_normals.begin(), by_normals.end());
  return starts;
}

/// The lowest minimum that any start leads to. Its feet are those of all points.
GivenCandidate search(CurveClass curve_class, const LocalPoints& local,
                      std::span<const int> sides) {
  constexpr std::size_t kMostSeedPoints = 64;
  constexpr std::size_t kMostOnAll = 2;
  // A good start settles within ten steps; a long valley may take a few dozen.
  constexpr DescentEffort kOnSome{60, 1e-6, 0.0};
  constexpr DescentEffort kOnAll{200, 1e-8, 0.0};
  std::vector<GivenCandidate> found;
  const std::vector<GivenStart> starts = starts_of(curve_class, local);
  for (const int side : sides) {
    const auto all = on_side(local.exact, side);
    const auto few = some(all, kMostSeedPoints);
    for (const GivenStart& start : starts) {
      GivenCandidate candidate;
      candidate.side = side;
      candidate.curve.curve_class = curve_class;
      for (int i = 0; i < 3; ++i) {
        candidate.curve.shape[i] = start.shape.values[i];
      }
      candidate.curve.origin = {start.pose.x, start.pose.y};
      candidate.curve.axis = {std::cos(start.pose.theta), std::sin(start.pose.theta)};
      descend_on(few, kOnSome, &candidate);
      if (std::isfinite(candidate.cost)) {
        found.push_back(std::move(candidate));
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), is_better);
  GivenCandidate best;
  for (std::size_t i = 0; i < std::min(found.size(), kMostOnAll); ++i) {
    // Skips a candidate that ended where the first one did.
    constexpr double kSame = 1e-6;
    if (i > 0 && found[i].side == found[0].side &&
        std::abs(found[i].cost - found[0].cost) <= kSame * found[0].cost) {
      continue;
    }
    descend_on(on_side(local.exact, found[i].side), kOnAll, &found[i]);
    if (is_better(found[i], best)) {
      best = std::move(found[i]);
    }
  }
  return best;
}

/// The sides of the curve on which tips may lie.
std::vector<int> sides_of(std::span<const GivenPoint> points) {
  const bool tips = std::any_of(points.begin(), points.end(), [](const GivenPoint& point) {
    return point.tip_radius_m > 0.0 && !point.set_aside;
  });
  return tips ? std::vector<int>{1, -1} : std::vector<int>{0};
}

/// Points whose stated material (or normal) contradicts the side, minus those that agree.
int votes_against(const GivenCandidate& candidate, const LocalPoints& local,
                  std::span<const GivenPoint> points) {
  int votes = 0;
  for (std::size_t k = 0; k < local.index.size(); ++k) {
    const GivenPoint& point = points[local.index[k]];
    const Vec2 into = point.into_material.isZero() ? Vec2(-point.normal) : point.into_material;
    if (into.isZero()) {
      continue;
    }
    const auto place_of = canonical_point(candidate.curve.curve_class, candidate.curve.shape,
                                          candidate.curve.feet[k]);
    const PlaneVector<double> local_into{inner(candidate.curve.axis, {into.x(), into.y()}),
                                         inner(left(candidate.curve.axis), {into.x(), into.y()})};
    // The tip's centre lies opposite the material.
    votes += candidate.side * inner(left(place_of.first), local_into) > 0.0 ? 1 : -1;
  }
  return votes;
}

/// Feet at which the curve bends towards the tip's centre, minus those at which it bends away:
/// above 0 if tips touch from inside the bends.
int feet_inside(const GivenCandidate& candidate) {
  int inside = 0;
  for (const auto& foot : candidate.curve.feet) {
    const auto place = canonical_point(candidate.curve.curve_class, candidate.curve.shape, foot);
    const double bend = candidate.side * inner(left(place.first), place.second);
    inside += bend > 0.0 ? 1 : bend < 0.0 ? -1 : 0;
  }
  return inside;
}

/// Whether the first of two curves with tips on opposite sides is to be told, where no point tells
/// the side. `towards`: feet_inside(u) less feet_inside(v).
bool is_preferred(const GivenCandidate& u, const GivenCandidate& v, int towards,
                  TouchedFrom touched_from) {
  // Both sides of a circle fit alike to rounding, which must not choose; probes come from outside.
  const bool alike = u.curve.curve_class == CurveClass::Circle;
  if (towards == 0 || (touched_from == TouchedFrom::Unknown && !alike)) {
    return is_better(u, v);
  }
  return (touched_from == TouchedFrom::Inside) == (towards > 0);
}

}  // namespace

SidedCandidate search_sides(CurveClass curve_class, const LocalPoints& local,
                            std::span<const GivenPoint> points, TouchedFrom touched_from) {
  SidedCandidate best;
  int best_votes = 0;
  for (const int side : sides_of(points)) {
    GivenCandidate candidate = search(curve_class, local, std::array{side});
    if (!std::isfinite(candidate.cost)) {
      continue;
    }
    const int votes = side == 0 ? 0 : votes_against(candidate, local, points);
    if (!std::isfinite(best.taken.cost)) {
      best.taken = std::move(candidate);
      best_votes = votes;
      continue;
    }
    const int towards = feet_inside(candidate) - feet_inside(best.taken);
    const bool by_votes = votes != best_votes;
    const bool preferred =
        by_votes ? votes < best_votes : is_preferred(candidate, best.taken, towards, touched_from);
    // A line has no bend that could tell.
    const bool told = by_votes || (touched_from != TouchedFrom::Unknown && towards != 0);
    if (!told) {
      best.cost_of_other = preferred ? best.taken.cost : candidate.cost;
    }
    if (preferred) {
      best.taken = std::move(candidate);
    }
  }
  return best;
}

}  // namespace palpate
