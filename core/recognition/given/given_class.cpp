#include "core/recognition/given/given_class.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "core/numerics/probability/mahalanobis.h"
#include "core/numerics/probability/negligible.h"
#include "core/numerics/probability/student_quantile.h"
#include "core/recognition/given/exact_fit.h"
#include "core/recognition/given/given_choice.h"
#include "core/recognition/given/given_limit.h"
#include "core/recognition/given/given_reach.h"
#include "core/recognition/given/given_report.h"
#include "core/recognition/given/given_search.h"
#include "core/recognition/given/local_points.h"
#include "core/recognition/given/placed/curve_moves.h"
#include "core/recognition/given/placed/descent.h"
#include "core/recognition/given/placed/stroke_feet.h"

namespace palpate {
namespace {

using Exact = DoubleDouble;

/// A line can slide freely: its origin is set to the place nearest to the mean of the points.
void slide_to_mean(const LocalPoints& local, PlacedCurve<double>* line) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& point : local.rough) {
    sum += point;
  }
  const Vec2 mean = sum / static_cast<double>(local.rough.size());
  const double along = line->to_curve({mean.x(), mean.y()}).x;
  line->origin = line->origin + along * line->axis;
  for (PlaneVector<double>& foot : line->feet) {
    foot.x -= along;
  }
}

/// Residuals are taken as at least the rounding of the coordinates.
double stationarity_of(const Squares<Exact>& squares, const LocalPoints& local, std::size_t n) {
  const auto moves = unit_moves(squares.information, n);
  const double least = local.rounding * to_double(local.exact.front().weight);
  const double length = std::max(std::sqrt(2.0 * to_double(squares.cost)), least);
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(to_double(squares.gradient[i])) / (moves[i] * length));
  }
  return largest;
}

/// Variance of the residuals' unit, as the costs have it: 1 if every noise is stated, else
/// estimated from the residuals. At least what the rounding of the coordinates makes of residuals.
double variance_of(double cost, int dof, const LocalPoints& local, bool stated) {
  // Roundings add up where unknowns depend on one another; so much noise hides them all.
  constexpr double kHides = 1e3;
  const double least = kHides * local.rounding * to_double(local.exact.front().weight);
  const double own = stated ? 1.0 : dof > 0 ? 2.0 * cost / dof : 0.0;
  return std::max(own, least * least);
}

/// log odds of one minimum over another one. Noise that is not stated may be of any size, alike
/// probable by its logarithm: integrated over it and over the unknowns, a sum of squares has the
/// power of -dof / 2. Below the rounding of the coordinates no residual says anything. A stroke
/// that jumps pays for the samples that are missing.
double log_odds_of(const GivenCandidate& one, const GivenCandidate& other, int dof,
                   const LocalPoints& local, bool stated) {
  if (stated) {
    return other.misfit - one.misfit;
  }
  const auto n = static_cast<double>(local.index.size());
  const double least = 0.5 * n * local.rounding * local.rounding;
  const int jumps = jumps_of(other.curve, other.points) - jumps_of(one.curve, one.points);
  return 0.5 * std::max(dof, 0) * std::log((other.cost + least) / (one.cost + least)) +
         kNegligibleLogOdds * jumps;
}

/// By how much a sum of squares, in the costs' unit, rises to where the truth hardly ever is.
double rise_of_reach(double cost, int dof, const LocalPoints& local, bool stated) {
  const double deviations = stated ? kReach : student_quantile(kReach, static_cast<double>(dof));
  return deviations * deviations * variance_of(cost, dof, local, stated);
}

/// The minima, with those that a walk along the valley of the taken one comes through.
struct Explored {
  std::vector<GivenCandidate> minima;
  GivenChoice choice;
  GivenReach reach;
};

/// Follows bent valleys of arms, in which descents have not come to an end: their steps are as
/// short as the valley is straight. Steps along it that hold one parameter reach its lowest place.
/// (A conic's valley leads to the limit of its class.)
void follow_valleys(const LocalPoints& local, const GivenNoise& noise, int dof,
                    std::vector<GivenCandidate>* minima) {
  // A bound of time: each takes some tens of descents. What is not at its end then stays unsettled,
  // and goes behind what is.
  constexpr int kMostWalks = 2;
  for (GivenCandidate& candidate : *minima) {
    const bool arms = candidate.curve.curve_class == CurveClass::SemiCubicalParabola ||
                      candidate.curve.curve_class == CurveClass::CubicSpline;
    for (int walk = 0; arms && walk < kMostWalks && !candidate.settled; ++walk) {
      const auto lower =
          reach_of(candidate,
                   kReach * kReach * variance_of(candidate.cost, dof, local, noise.stated))
              .lower;
      if (!lower) {
        break;
      }
      GivenCandidate trial;
      trial.side = candidate.side;
      trial.arm = candidate.arm;
      trial.curve = *lower;
      trial.points = candidate.points;
      settle(local, noise, &trial);
      if (!std::isfinite(trial.cost)) {
        break;
      }
      candidate = std::move(trial);
    }
  }
  std::stable_sort(minima->begin(), minima->end(), is_better);
}

Explored explore(CurveClass curve_class, const LocalPoints& local, const GivenNoise& noise,
                 TouchedFrom touched_from, int dof) {
  // A bound of time: each but the last may find a minimum that is lower than all that the search
  // has found. The last passes what is lower, so that the reach holds it.
  constexpr int kMostWalks = 4;
  Explored explored;
  explored.minima = search_minima(curve_class, local, noise);
  follow_valleys(local, noise, dof, &explored.minima);
  if (explored.minima.empty()) {
    return explored;
  }
  for (int walk = 1;; ++walk) {
    explored.choice = choose(explored.minima, local, noise.points, touched_from);
    const GivenCandidate& taken = explored.minima[explored.choice.taken];
    explored.reach = {};
    if (!taken.settled || (!noise.stated && dof <= 0)) {
      break;
    }
    const double rise = rise_of_reach(taken.cost, dof, local, noise.stated);
    explored.reach = reach_of(taken, rise, walk < kMostWalks ? AtLower::Stop : AtLower::Pass);
    if (!explored.reach.lower) {
      break;
    }
    GivenCandidate lower;
    lower.side = taken.side;
    lower.arm = taken.arm;
    lower.curve = *explored.reach.lower;
    settle(local, noise, &lower);
    if (!is_better(lower, taken)) {
      // The walk has stopped there: the reach of the rest of the way is not yet known.
      explored.reach = reach_of(taken, rise, AtLower::Pass);
      break;
    }
    explored.minima.push_back(std::move(lower));
    std::stable_sort(explored.minima.begin(), explored.minima.end(), is_better);
  }
  return explored;
}

/// Follows a valley whose descent was short of its end, while that gains: for as many steps as ten
/// descents have, if the limit of its class (of that misfit) fits worse than what is found, so that
/// there is a minimum; else for as many as two, in which a minimum shows that the limit is beside.
void follow(double limit, const LocalPoints& local, const GivenNoise& noise,
            GivenCandidate* valley) {
  constexpr int kMostDescents = 10;  // a bound of time: what still gains then stays unsettled
  constexpr int kDescentsToLimit = 2;
  for (int i = 0; i < kMostDescents && !valley->settled; ++i) {
    const double before = valley->cost;
    settle(local, noise, valley);
    const bool may_end = limit > valley->misfit + kAlike || i + 1 < kDescentsToLimit;
    if (!(valley->cost < before) || !may_end) {
      break;
    }
  }
}

/// What a descent that has not come to an end would still gain of the cost, were the valley
/// straight.
double gain_ahead(const GivenCandidate& valley) {
  PlacedCurve<double> at = valley.curve;
  const auto n = static_cast<std::size_t>(Unknowns(at.curve_class).count);
  const auto squares = squares_about(&at, std::span<const WeighedPoint<double>>(valley.points));
  const auto moves = unit_moves(squares.information, n);
  const auto lower = lower_factor(in_unit_moves(squares.information, n, moves), n, 0.0);
  if (!lower) {
    return std::numeric_limits<double>::infinity();
  }
  std::array<double, kMostUnknowns> slope{};
  for (std::size_t i = 0; i < n; ++i) {
    slope[i] = squares.gradient[i] / moves[i];
  }
  const auto step = solve(*lower, n, slope);
  double gain = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    gain += 0.5 * step[i] * slope[i];
  }
  return gain;
}

/// Whether `other` lies outside of where the covariance of the unknowns says that the curve is.
bool is_outside(const GivenCandidate& taken, const GivenCandidate& other,
                const ShapePoseCovariance& covariance, double variance) {
  const auto n = covariance.rows();
  const auto step = move_between(taken.curve, other.curve).step;
  const double outside =
      chi_square_threshold(std::erfc(kReach / std::numbers::sqrt2), static_cast<int>(n));
  return !(mahalanobis_square(Eigen::Map<const Eigen::VectorXd>(step.data(), n), covariance) <=
           outside * variance);
}

/// Tells the odds over the best minimum of the other side, and the most probable other curve;
/// whether valleys lead away from the one that is taken. `of_unknowns`, `variance`: as
/// is_outside has them.
void tell_others(const Explored& explored, const LocalPoints& local, const GivenNoise& noise,
                 int dof, const ShapePoseCovariance& of_unknowns, double variance, GivenFit* fit) {
  const GivenChoice& choice = explored.choice;
  const GivenCandidate& taken = explored.minima[choice.taken];
  const auto odds_over = [&](const GivenCandidate& other) {
    return log_odds_of(taken, other, dof, local, noise.stated);
  };
  std::vector<std::size_t> others = choice.twins;
  if (choice.other_side) {
    fit->side_log_odds = odds_over(explored.minima[*choice.other_side]);
    others.push_back(*choice.other_side);
  }
  const GivenCandidate* rival = nullptr;
  for (const std::size_t i : others) {
    const GivenCandidate& other = explored.minima[i];
    if (i != choice.other_side && !is_outside(taken, other, of_unknowns, variance)) {
      continue;
    }
    if (!other.settled) {
      // A valley with no end in sight leads away from the curve: there is no other shape to tell.
      GivenCandidate end = other;
      const double gain = std::min(gain_ahead(end), end.cost);
      end.cost -= gain;
      end.misfit -= gain;
      fit->bounded = fit->bounded && odds_over(end) > 0.5 * kReach * kReach;
    } else if (rival == nullptr || odds_over(other) < odds_over(*rival)) {
      rival = &other;
    }
  }
  if (rival != nullptr) {
    GivenRival& told = fit->rival.emplace();
    report_place(exact_of(rival->curve), local, &told.shape, &told.world_T_curve);
    told.log_odds = odds_over(*rival);
    told.chi2 = 2.0 * rival->cost / (noise.stated ? 1.0 : variance);
  }
}

/// Whether the rounding of a spline's parameters moves it by less than the noise does: of one with
/// its vertex far away they may be exact to the last digit, and yet no curve near the points.
/// `variance`: of the residuals' unit.
bool is_held_by_double(const PlacedCurve<Exact>& spline, const LocalPoints& local,
                       double variance) {
  constexpr double kPartOfNoise = 0.1;  // adds a hundredth to its variance
  const auto size_of = [](const Exact& value) { return std::abs(to_double(value)); };
  double t = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < spline.feet.size(); ++i) {
    t = std::max(t, size_of(spline.feet[i].x));
    weight = std::max(weight, to_double(local.exact[i].weight));
  }
  const double terms = ((size_of(spline.shape[0]) * t + size_of(spline.shape[1]) + 1.0) * t +
                        size_of(spline.shape[2])) *
                       t;
  return std::numeric_limits<double>::epsilon() * terms * weight <
         kPartOfNoise * std::sqrt(variance);
}

/// Why the points tell no curve of the class, or nullopt.
std::optional<GivenStatus> lacking(CurveClass curve_class, const LocalPoints& local) {
  if (different(local.rough) + local.normals <
      static_cast<std::size_t>(degrees_of_freedom(curve_class))) {
    return GivenStatus::TooFewPoints;
  }
  // Two touches with normals lie on one line, but determine a circle.
  if (curve_class != CurveClass::Line && local.normals == 0 && on_one_line(local)) {
    return GivenStatus::Collinear;
  }
  return std::nullopt;
}

}  // namespace

std::string_view name_of(GivenStatus status) {
  switch (status) {
    case GivenStatus::Fitted:
      return "fitted";
    case GivenStatus::NotFinite:
      return "not finite";
    case GivenStatus::TooFewPoints:
      return "too few points";
    case GivenStatus::Collinear:
      return "collinear";
    case GivenStatus::AtLimit:
      return "at limit";
    case GivenStatus::Unfinished:
      return "unfinished";
    case GivenStatus::NotDetermined:
      return "not determined";
  }
  return "";
}

GivenFit fit_given_class(CurveClass curve_class, std::span<const GivenPoint> points,
                         const GivenOptions& options) {
  GivenFit fit;
  fit.shape.curve_class = curve_class;
  bool stated = true;
  for (const GivenPoint& point : points) {
    if (!is_sound(point)) {
      return fit;
    }
    stated = stated && (point.set_aside || noise_of(point, options.sigma_m) > 0.0);
  }
  fit.status = GivenStatus::TooFewPoints;
  // Stated and unstated noise do not mix: if one is not stated, the noise of all is estimated.
  const auto local = local_points(points, options.sigma_m, stated);
  if (!local || curve_class == CurveClass::Unclassified) {
    return fit;
  }
  fit.used = local->index.size();
  if (const auto why = lacking(curve_class, *local)) {
    fit.status = *why;
    return fit;
  }
  const int dof =
      static_cast<int>(local->index.size() + local->normals) - degrees_of_freedom(curve_class);
  const GivenNoise noise{points, options.sigma_m, stated};
  Explored explored = explore(curve_class, *local, noise, options.touched_from, dof);
  if (explored.minima.empty()) {
    fit.status = std::isfinite(misfit_of_limit(curve_class, *local, noise))
                     ? GivenStatus::AtLimit
                     : GivenStatus::Unfinished;
    return fit;
  }
  GivenCandidate found = explored.minima[explored.choice.taken];
  if (curve_class == CurveClass::Line) {
    slide_to_mean(*local, &found.curve);
  }
  ExactFit exact = exact_fit(found, *local, noise);
  const bool walked = found.settled;  // explore() has, from there
  if (!exact.descent.settled && !found.settled) {
    const double limit = misfit_of_limit(curve_class, *local, noise);
    follow(limit, *local, noise, &found);
    if (!found.settled) {
      fit.status = limit <= found.misfit + kAlike ? GivenStatus::AtLimit : GivenStatus::Unfinished;
      return fit;
    }
    explored.minima[explored.choice.taken] = found;
    exact = exact_fit(found, *local, noise);
  }
  fit.status = GivenStatus::Fitted;
  fit.side = found.side;
  fit.stationarity = stationarity_of(exact.descent.squares, *local,
                                     static_cast<std::size_t>(Unknowns(curve_class).count));
  GivenReach reach = explored.reach;
  if (!walked && (stated || dof > 0)) {
    // Only twice the digits have told where the valley is lowest: nobody has walked from there.
    found.curve = rounded(exact.placed);
    reach = reach_of(found, rise_of_reach(found.cost, dof, *local, stated));
    reach.bounded = reach.bounded && !reach.lower;
  }
  fit.bounded = reach.bounded;
  report_place(exact.placed, *local, &fit.shape, &fit.world_T_curve);
  const ShapePoseCovariance of_unknowns =
      report_covariance(exact.placed, exact.descent.squares, *local, reach, &fit);
  const double variance = variance_of(found.cost, dof, *local, stated);
  if (curve_class == CurveClass::CubicSpline &&
      !is_held_by_double(exact.placed, *local, variance)) {
    fit.status = GivenStatus::NotDetermined;
  }
  tell_others(explored, *local, noise, dof, of_unknowns, variance, &fit);
  report_residuals(&exact.placed, *local, points, &fit);
  report_noise(points, *local, stated, options.sigma_m, 2.0 * to_double(exact.descent.squares.cost),
               &fit);
  settle_pose(points, *local, &fit);
  return fit;
}

}  // namespace palpate
