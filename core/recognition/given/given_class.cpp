#include "core/recognition/given/given_class.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/recognition/given/descent.h"
#include "core/recognition/given/foot_parameter.h"
#include "core/recognition/given/foot_weights.h"
#include "core/recognition/given/given_report.h"
#include "core/recognition/given/given_search.h"
#include "core/recognition/given/local_points.h"

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

PlacedCurve<Exact> exact_of(const PlacedCurve<double>& curve) {
  PlacedCurve<Exact> exact;
  exact.curve_class = curve.curve_class;
  for (int i = 0; i < 3; ++i) {
    exact.shape[i] = Exact(curve.shape[i]);
  }
  exact.origin = as<Exact>(curve.origin);
  exact.axis = as<Exact>(curve.axis);
  exact.axis = Exact(1.0) / sqrt(inner(exact.axis, exact.axis)) * exact.axis;
  for (const PlaneVector<double>& foot : curve.feet) {
    exact.feet.push_back(as<Exact>(foot));
  }
  if (curve.curve_class == CurveClass::Circle || curve.curve_class == CurveClass::Ellipse) {
    for (PlaneVector<Exact>& foot : exact.feet) {
      foot = Exact(1.0) / sqrt(inner(foot, foot)) * foot;
    }
  }
  return exact;
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

/// log odds of one side over the other by their costs, half the sums of squares. Noise that is not
/// stated may be of any size, alike probable by its logarithm; below the rounding of the
/// coordinates no residual says anything.
double log_odds_of_side(double cost, double cost_of_other, const LocalPoints& local, bool stated) {
  if (stated) {
    return cost_of_other - cost;
  }
  const auto n = static_cast<double>(local.index.size());
  const double least = 0.5 * n * local.rounding * local.rounding;
  return 0.5 * n * std::log((cost_of_other + least) / (cost + least));
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
  if (different(local->rough) + local->normals <
      static_cast<std::size_t>(degrees_of_freedom(curve_class))) {
    return fit;
  }
  // Two touches with normals lie on one line, but determine a circle.
  if (curve_class != CurveClass::Line && local->normals == 0 && on_one_line(*local)) {
    fit.status = GivenStatus::Collinear;
    return fit;
  }
  fit.status = GivenStatus::AtLimit;
  const SidedCandidate sided = search_sides(curve_class, *local, points, options.touched_from);
  GivenCandidate found = sided.taken;
  if (!std::isfinite(found.cost)) {
    return fit;
  }
  if (curve_class == CurveClass::Line) {
    slide_to_mean(*local, &found.curve);
  }
  PlacedCurve<Exact> placed = exact_of(found.curve);
  std::vector<WeighedPoint<Exact>> exact = local->exact;
  for (WeighedPoint<Exact>& point : exact) {
    point.offset = Exact(static_cast<double>(found.side)) * point.offset;
  }
  // Newton converges quadratically: after a step that moves residuals by 1e-17, the next one is
  // below the rounding of a double.
  constexpr DescentEffort kToRounding{40, 1e-17, 1e-6};
  const auto seat = [](PlacedCurve<Exact>* trial) { return curve_of(*trial).has_value(); };
  auto descent = descend(&placed, std::span<const WeighedPoint<Exact>>(exact), kToRounding, seat);
  if (stated) {
    // Each round reduces the error of the weights by about noise / radius of curvature.
    constexpr int kMostRounds = 40;
    constexpr double kSame = 1e-14;
    for (int round = 0; round < kMostRounds; ++round) {
      if (weigh_at_feet(placed, *local, points, options.sigma_m, &exact) <= kSame) {
        break;
      }
      descent = descend(&placed, std::span<const WeighedPoint<Exact>>(exact), kToRounding, seat);
    }
  }
  if (!descent.settled && !found.settled) {
    return fit;
  }
  fit.status = GivenStatus::Fitted;
  fit.side = found.side;
  if (std::isfinite(sided.cost_of_other)) {
    fit.side_log_odds = log_odds_of_side(found.cost, sided.cost_of_other, *local, stated);
  }
  fit.stationarity = stationarity_of(descent.squares, *local,
                                     static_cast<std::size_t>(Unknowns(curve_class).count));
  report_curve(placed, descent.squares, *local, &fit);
  report_residuals(&placed, *local, points, &fit);
  report_noise(points, *local, stated, options.sigma_m, 2.0 * to_double(descent.squares.cost),
               &fit);
  settle_pose(points, *local, &fit);
  return fit;
}

}  // namespace palpate
