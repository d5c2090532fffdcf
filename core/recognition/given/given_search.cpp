#include "core/recognition/given/given_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/curves/cubic_spline.h"
#include "core/recognition/fit/few_points.h"
#include "core/recognition/given/axis_scan.h"
#include "core/recognition/given/curve_moves.h"
#include "core/recognition/given/foot_parameter.h"
#include "core/recognition/given/foot_weights.h"
#include "core/recognition/given/given_starts.h"
#include "core/recognition/given/thinned.h"

namespace palpate {
namespace {

/// A good start settles within ten steps; a long valley may take many dozens.
constexpr DescentEffort kOnFew{60, 1e-6, 0.0};

/// Moves every foot to the nearest place of the curve beside it. False if the shape is outside the
/// class.
bool seat_nearby(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points) {
  const auto curve = curve_of(*placed);
  if (!curve) {
    return false;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlaneVector<double> p = placed->to_curve(points[i].position);
    const double t = t_at(placed->curve_class, placed->feet[i]);
    const FootPoint foot = foot_point_near(*curve, {p.x, p.y}, t);
    if (!std::isfinite(foot.distance)) {
      return false;
    }
    placed->feet[i] = parameter_at(placed->curve_class, foot.t);
  }
  return true;
}

bool is_on_arm(int arm, const PlacedCurve<double>& placed) {
  return std::all_of(placed.feet.begin(), placed.feet.end(),
                     [arm](const PlaneVector<double>& foot) { return arm * foot.x > 0.0; });
}

/// Sets the feet where the candidate has none: on its arm, of a curve whose points are (t^2, ...),
/// or to the nearest places.
bool seat_first(std::span<const WeighedPoint<double>> points, GivenCandidate* candidate) {
  PlacedCurve<double>& placed = candidate->curve;
  if (candidate->arm == 0) {
    return seat_globally(&placed, points);
  }
  double farthest = 0.0;
  for (const WeighedPoint<double>& point : points) {
    farthest = std::max(farthest, placed.to_curve(point.position).x);
  }
  // So near one another that Newton's method reaches the foot from the nearest one.
  constexpr int kPlaces = 48;
  std::array<PlaneVector<double>, kPlaces> places;
  std::array<double, kPlaces> t{};
  for (std::size_t k = 0; k < kPlaces; ++k) {
    t[k] = candidate->arm * std::sqrt(farthest) * (static_cast<double>(k) + 0.5) / kPlaces;
    places[k] = curve_point<double>(placed.curve_class, placed.shape, {t[k], 0.0}).position;
  }
  placed.feet.clear();
  for (const WeighedPoint<double>& point : points) {
    const PlaneVector<double> p = placed.to_curve(point.position);
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const PlaneVector<double> away = p - places[k];
      const double square = inner(away, away);
      nearest = square < least ? k : nearest;
      least = std::min(least, square);
    }
    placed.feet.push_back({t[nearest], 0.0});
  }
  return seat_nearby(&placed, points) && is_on_arm(candidate->arm, placed);
}

bool is_same_cost(double u, double v) {
  constexpr double kRounding = 1e-9;  // relative: what it makes of a sum
  return std::abs(u - v) <= kRounding * v;
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

/// Appends the best spline with its bend at t = 0 no sharper than a circle of that radius, as tip
/// centres go about a corner. Where none of them lies on that bend, splines through them are cusps.
void add_rounded(double radius, std::vector<GivenStart>* starts) {
  const double least = CubicSpline::c_of_bend(radius);
  if (!starts->empty() && starts->front().shape.values[2] < least) {
    starts->push_back(starts->front());
    starts->back().shape.values[2] = least;
  }
}

/// Hyperbolas that bend at their vertex as the parabolas do. Of a short arc, the conics of least
/// algebraic distance may all be ellipses, but for a pair of lines.
std::vector<GivenStart> beside_parabolas(std::span<const GivenStart> parabolas) {
  // In half extents of the points: over these, the nearer one turns towards its asymptotes, and the
  // farther one is a parabola to some hundredths.
  constexpr std::array kHalfAxes{1.0, 8.0};
  std::vector<GivenStart> hyperbolas;
  for (const GivenStart& parabola : parabolas) {
    for (const double a : kHalfAxes) {
      // Beside the vertex y^2 = 2 b^2 (x - a) / a, of a parabola 4 (its a) x.
      GivenStart hyperbola = parabola;
      hyperbola.shape.curve_class = CurveClass::Hyperbola;
      hyperbola.shape.values = {a, std::sqrt(2.0 * a * parabola.shape.values[0]), 0.0};
      hyperbola.pose.x -= a * std::cos(parabola.pose.theta);
      hyperbola.pose.y -= a * std::sin(parabola.pose.theta);
      hyperbolas.push_back(hyperbola);
    }
  }
  return hyperbolas;
}

/// Starts from the points. If normals are measured, also from two extra places per point, on its
/// tangent to either side: so there are starts for fewer points than the class has unknowns.
std::vector<GivenStart> starts_of(CurveClass curve_class, const LocalPoints& local) {
  std::vector<GivenStart> starts = given_starts(curve_class, local.rough);
  std::vector<double> radii;
  for (const WeighedPoint<DoubleDouble>& point : local.exact) {
    radii.push_back(to_double(point.offset));
  }
  if (curve_class == CurveClass::CubicSpline) {
    add_rounded(*std::max_element(radii.begin(), radii.end()), &starts);
  }
  const std::vector<GivenStart> by_axis =
      curve_class == CurveClass::Hyperbola
          ? beside_parabolas(starts_by_axis(CurveClass::Parabola, local.rough, radii))
          : starts_by_axis(curve_class, local.rough, radii);
  starts.insert(starts.end(), by_axis.begin(), by_axis.end());
  // Twice as many points as the most unknowns: then the scan needs no normals.
  constexpr std::size_t kEnough = 2 * kMostUnknowns;
  if (local.normals == 0 || (!by_axis.empty() && local.rough.size() >= kEnough)) {
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

/// The sides of the curve on which tips may lie.
std::vector<int> sides_of(std::span<const GivenPoint> points) {
  const bool tips = std::any_of(points.begin(), points.end(), [](const GivenPoint& point) {
    return point.tip_radius_m > 0.0 && !point.set_aside;
  });
  return tips ? std::vector<int>{1, -1} : std::vector<int>{0};
}

/// -log likelihood of the candidate's points, up to a constant. Noise that is not stated is the one
/// that the residuals have; at least the rounding of the coordinates.
double misfit_of(const GivenCandidate& candidate, const LocalPoints& local, bool stated) {
  if (!stated) {
    const auto n = static_cast<double>(local.index.size());
    return 0.5 * n * std::log(candidate.cost + 0.5 * n * local.rounding * local.rounding);
  }
  double sum = candidate.cost;
  for (const WeighedPoint<double>& point : candidate.points) {
    sum -= std::log(point.weight);
    sum -= point.normal_weight > 0.0 ? std::log(point.normal_weight) : 0.0;
  }
  return sum;
}

PlacedCurve<double> placed_at(const GivenStart& start) {
  PlacedCurve<double> curve;
  curve.curve_class = start.shape.curve_class;
  for (int i = 0; i < 3; ++i) {
    curve.shape[i] = start.shape.values[i];
  }
  curve.origin = {start.pose.x, start.pose.y};
  curve.axis = {std::cos(start.pose.theta), std::sin(start.pose.theta)};
  return curve;
}

/// The minima that the starts lead to on few of the points, the better ones first.
std::vector<GivenCandidate> minima_on_few(std::span<const GivenStart> starts, int side,
                                          std::span<const WeighedPoint<double>> few) {
  std::vector<GivenCandidate> found;
  std::vector<PlacedCurve<double>> begun;
  for (const GivenStart& start : starts) {
    if (start.side != 0 && start.side != side) {
      continue;
    }
    GivenCandidate candidate;
    candidate.side = side;
    candidate.curve = placed_at(start);
    const bool again =
        std::any_of(begun.begin(), begun.end(), [&](const PlacedCurve<double>& other) {
          bool backwards = false;
          return is_same_curve(other, candidate.curve, &backwards) && !backwards;
        });
    if (again) {
      continue;
    }
    begun.push_back(candidate.curve);
    candidate.arm = start.arm;
    descend_on(few, kOnFew, &candidate);
    if (start.arm != 0) {
      GivenCandidate nearest = candidate;
      nearest.arm = 0;
      if (!std::isfinite(candidate.cost) || !seat_globally(&nearest.curve, few)) {
        nearest.curve.feet.clear();
      }
      descend_on(few, kOnFew, &nearest);
      // Without tips, the nearer arm is the one that is meant.
      if (side == 0 || is_same_cost(nearest.cost, candidate.cost)) {
        candidate = std::move(nearest);
      } else if (std::isfinite(nearest.cost)) {
        nearest.misfit = nearest.cost;
        found.push_back(std::move(nearest));
      }
    }
    candidate.misfit = candidate.cost;
    if (std::isfinite(candidate.cost)) {
      found.push_back(std::move(candidate));
    }
  }
  std::stable_sort(found.begin(), found.end(), is_better);
  return found;
}

/// The misfit on all points of a curve that was found on few of them.
void look_at_all(const LocalPoints& local, const GivenNoise& noise, GivenCandidate* candidate) {
  candidate->points = on_side(local.exact, candidate->side);
  if (!seat_first(candidate->points, candidate)) {
    candidate->misfit = std::numeric_limits<double>::infinity();
    return;
  }
  if (noise.stated) {
    weigh_at_feet(candidate->curve, local, noise.points, noise.default_sigma_m, &candidate->points);
  }
  candidate->cost =
      half_squares(&candidate->curve, std::span<const WeighedPoint<double>>(candidate->points));
  // What a descent that ends with so short steps has not yet gained.
  candidate->cost =
      std::max(0.0, candidate->cost - kMostUnknowns * kOnFew.last_step * kOnFew.last_step);
  candidate->misfit = misfit_of(*candidate, local, noise.stated);
}

/// Whether one of `others` is the same curve with the tips on the same side of it.
bool is_among(const GivenCandidate& candidate, std::span<const GivenCandidate> others) {
  return std::any_of(others.begin(), others.end(), [&](const GivenCandidate& other) {
    bool backwards = false;
    return candidate.settled == other.settled &&
           is_same_curve(other.curve, candidate.curve, &backwards) &&
           candidate.side == (backwards ? -other.side : other.side);
  });
}

}  // namespace

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

void descend_on(std::span<const WeighedPoint<double>> points, const DescentEffort& effort,
                GivenCandidate* candidate) {
  const int arm = candidate->arm;
  // Of many points, which begin near a minimum of few, feet that move along cost a third.
  const bool near_first = arm == 0 && points.size() > kMostSearchedPoints;
  const auto nearby = [&](PlacedCurve<double>* trial) {
    return seat_nearby(trial, points) && (arm == 0 || is_on_arm(arm, *trial));
  };
  const auto globally = [&](PlacedCurve<double>* trial) { return seat_globally(trial, points); };
  candidate->settled = false;
  candidate->cost = std::numeric_limits<double>::infinity();
  PlacedCurve<double>& curve = candidate->curve;
  if (curve.feet.size() != points.size() ? !seat_first(points, candidate)
      : arm == 0 && !near_first          ? !globally(&curve)
                                         : !nearby(&curve)) {
    return;
  }
  auto descent = arm != 0 || near_first ? descend(&curve, points, effort, nearby)
                                        : descend(&curve, points, effort, globally);
  if (near_first) {
    const double cost = descent.squares.cost;
    if (!globally(&curve)) {
      return;
    }
    if (!is_same_cost(half_squares(&curve, points), cost)) {
      descent = descend(&curve, points, effort, globally);
    }
  }
  candidate->cost = descent.squares.cost;
  candidate->settled = descent.settled;
}

bool is_better(const GivenCandidate& u, const GivenCandidate& v) {
  // Of the noise, so much of -log likelihood is hardly ever: then the truth is in the valley.
  constexpr double kExcluded = 0.5 * kReach * kReach;
  const auto handicapped = [](const GivenCandidate& candidate) {
    return candidate.misfit + (candidate.settled ? 0.0 : kExcluded);
  };
  return handicapped(u) < handicapped(v);
}

void settle(const LocalPoints& local, const GivenNoise& noise, GivenCandidate* candidate) {
  constexpr DescentEffort kOnAll{100, 1e-8, 0.0};
  constexpr int kMostRounds = 10;
  // Relative: of a weight, then less than that of what the residuals tell of the curve.
  constexpr double kSame = 1e-6;
  candidate->points = on_side(local.exact, candidate->side);
  descend_on(candidate->points, kOnAll, candidate);
  for (int round = 0; noise.stated && candidate->settled && round < kMostRounds; ++round) {
    if (weigh_at_feet(candidate->curve, local, noise.points, noise.default_sigma_m,
                      &candidate->points) <= kSame) {
      break;
    }
    descend_on(candidate->points, kOnAll, candidate);
  }
  candidate->misfit = misfit_of(*candidate, local, noise.stated);
}

std::vector<GivenCandidate> search_minima(CurveClass curve_class, const LocalPoints& local,
                                          const GivenNoise& noise) {
  // Of either side, minima and valleys each. So many has a short arm of a semi-cubical parabola,
  // seen from few touches; further ones lie above these. A valley that has not been followed on all
  // points may hold the truth as well as a minimum.
  constexpr std::size_t kMostOnAll = 8;
  // In the logarithm of the likelihood: far beyond what any odds asked for need. From the minimum
  // on few points to that on all, each unknown gains half of their ratio on average.
  constexpr double kHopeless = 50.0;
  const double hopeless = kHopeless + 0.5 * kMostUnknowns *
                                          static_cast<double>(local.exact.size()) /
                                          static_cast<double>(kMostSearchedPoints);
  const std::vector<GivenStart> starts = starts_of(curve_class, local);
  std::vector<GivenCandidate> minima;
  double lowest = std::numeric_limits<double>::infinity();
  for (const int side : sides_of(noise.points)) {
    const auto few = thinned<WeighedPoint<double>>(on_side(local.exact, side), kMostSearchedPoints);
    std::vector<GivenCandidate> distinct;
    std::size_t settled_left = kMostOnAll;
    std::size_t unsettled_left = kMostOnAll;
    for (GivenCandidate& candidate : minima_on_few(starts, side, few)) {
      std::size_t& left = candidate.settled ? settled_left : unsettled_left;
      if (left > 0 && !is_among(candidate, distinct)) {
        --left;
        distinct.push_back(std::move(candidate));
      }
    }
    for (GivenCandidate& candidate : distinct) {
      look_at_all(local, noise, &candidate);
    }
    std::stable_sort(distinct.begin(), distinct.end(), is_better);
    // The first one of a side is always followed: it tells by how much that side fits worse.
    for (std::size_t k = 0; k < distinct.size(); ++k) {
      GivenCandidate& candidate = distinct[k];
      if (k > 0 && candidate.misfit > lowest + hopeless) {
        continue;
      }
      settle(local, noise, &candidate);
      if (std::isfinite(candidate.cost) && !is_among(candidate, minima)) {
        lowest = candidate.settled ? std::min(lowest, candidate.misfit) : lowest;
        minima.push_back(std::move(candidate));
      }
    }
  }
  std::stable_sort(minima.begin(), minima.end(), is_better);
  return minima;
}

}  // namespace palpate
