#include "core/recognition/given/given_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/starts/few_points.h"
#include "core/recognition/given/all_starts.h"
#include "core/recognition/given/as_polynomial.h"
#include "core/recognition/given/foot_weights.h"
#include "core/recognition/given/placed/curve_moves.h"
#include "core/recognition/given/placed/seated_feet.h"
#include "core/recognition/given/placed/stroke_feet.h"
#include "core/recognition/given/starts/thinned.h"

namespace palpate {
namespace {

/// A good start settles within ten steps; a long valley may take many dozens.
constexpr DescentEffort kOnFew{60, 1e-6, 0.0};

/// Sets the feet where the candidate has none.
bool seat_first(std::span<const WeighedPoint<double>> points, GivenCandidate* candidate) {
  return candidate->arm == 0 ? seat_globally(&candidate->curve, points)
                             : seat_on_arm(candidate->arm, &candidate->curve, points);
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
                      to_double(point.normal_weight), point.stroke, point.stated});
  }
  return points;
}

/// -log likelihood of the candidate's points, up to a constant. Noise that is not stated is the one
/// that the residuals have; at least the rounding of the coordinates. That a stroke goes on where
/// it cannot have come to is negligibly probable.
double misfit_of(const GivenCandidate& candidate, const LocalPoints& local, bool stated) {
  const bool placed = std::isfinite(candidate.cost);
  const double of_jumps =
      placed ? kNegligibleLogOdds * jumps_of(candidate.curve, candidate.points) : 0.0;
  if (!stated) {
    const auto n = static_cast<double>(local.index.size());
    return 0.5 * n * std::log(candidate.cost + 0.5 * n * local.rounding * local.rounding) +
           of_jumps;
  }
  double sum = candidate.cost + of_jumps;
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

std::vector<int> sides_of(std::span<const GivenPoint> points) {
  const bool tips = std::any_of(points.begin(), points.end(), [](const GivenPoint& point) {
    return point.tip_radius_m > 0.0 && !point.set_aside;
  });
  return tips ? std::vector<int>{1, -1} : std::vector<int>{0};
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

void settle(const LocalPoints& local, const GivenNoise& noise, GivenCandidate* candidate,
            const HeldUnknowns& held) {
  const DescentEffort on_all{100, 1e-8, 0.0, held};
  // Each leaves of the weights' error about the noise over the radius of curvature: with a tenth of
  // it, ten leave rounding.
  constexpr int kMostRounds = 10;
  // Relative: of a weight, then less than that of what the residuals tell of the curve.
  constexpr double kSame = 1e-6;
  candidate->points = on_side(local.exact, candidate->side);
  descend_on(candidate->points, on_all, candidate);
  for (int round = 0; noise.stated && candidate->settled && round < kMostRounds; ++round) {
    if (weigh_at_feet(candidate->curve, local, noise.points, noise.default_sigma_m,
                      &candidate->points) <= kSame) {
      break;
    }
    descend_on(candidate->points, on_all, candidate);
  }
  if (held.none()) {
    descend_as_polynomial(local, noise.stated, candidate);
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
