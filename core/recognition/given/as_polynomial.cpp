#include "core/recognition/given/as_polynomial.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/curves/algebraic/canonical_cubic.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/given/exact_fit.h"
#include "core/recognition/given/placed/foot_parameter.h"
#include "core/recognition/given/placed/seated_feet.h"
#include "core/recognition/given/placed/stroke_feet.h"

namespace palpate {
namespace {

Vec2 as_eigen(const PlaneVector<double>& v) { return {v.x, v.y}; }

/// Noise that is not stated is as large as what the curve leaves.
std::vector<FitPoint> fit_points(const GivenCandidate& candidate, bool noise_is_stated) {
  const double n = static_cast<double>(candidate.points.size());
  const double variance = noise_is_stated ? 1.0 : 2.0 * candidate.cost / n;
  std::vector<FitPoint> points;
  points.reserve(candidate.points.size());
  for (const WeighedPoint<double>& weighed : candidate.points) {
    FitPoint& point = points.emplace_back();
    point.position = as_eigen(weighed.position);
    point.inverse_sigma = weighed.weight / std::sqrt(variance);
    point.offset = std::abs(weighed.offset);
    if (weighed.normal_weight > 0.0) {
      point.normal = as_eigen(weighed.normal);
      point.inverse_normal_sigma = weighed.normal_weight;
    }
  }
  return points;
}

/// The candidate by t / half + middle, the parameters of its feet about the middle of their range:
/// its terms are then of the points' size. They come from much larger ones.
PolynomialFit polynomial_of(const GivenCandidate& candidate) {
  const auto& feet = candidate.curve.feet;
  const auto [first, last] = std::minmax_element(
      feet.begin(), feet.end(), [](const auto& u, const auto& v) { return u.x < v.x; });
  const double middle = 0.5 * (first->x + last->x);
  const double half = 0.5 * (last->x - first->x);
  const PlacedCurve<DoubleDouble> exact = exact_of(candidate.curve);
  const auto at = curve_point<DoubleDouble>(exact.curve_class, exact.shape,
                                            {DoubleDouble(middle), DoubleDouble(0.0)});
  const auto in_points_frame = [&](const PlaneVector<DoubleDouble>& v) {
    return as_eigen(as_double(v.x * exact.axis + v.y * left(exact.axis)));
  };
  PolynomialFit fit;
  fit.coefficients.col(0) = as_eigen(
      as_double(exact.origin + at.position.x * exact.axis + at.position.y * left(exact.axis)));
  fit.coefficients.col(1) = half * in_points_frame(at.first);
  fit.coefficients.col(2) = 0.5 * half * half * in_points_frame(at.second);
  fit.coefficients.col(3) =
      half * half * half * in_points_frame({DoubleDouble(0.0), exact.shape[0]});
  for (const PlaneVector<double>& foot : feet) {
    fit.t.push_back((foot.x - middle) / half);
  }
  return fit;
}

/// nullopt where that is no spline that a double holds.
std::optional<PlacedCurve<double>> placed_curve(const PolynomialFit& fit) {
  const auto canonical =
      canonicalise_as(CurveClass::CubicSpline, PolynomialCurve2{fit.coefficients}).curve;
  if (!canonical) {
    return std::nullopt;
  }
  PlacedCurve<double> curve;
  curve.curve_class = CurveClass::CubicSpline;
  for (int i = 0; i < 3; ++i) {
    curve.shape[i] = canonical->values[i];
  }
  const Pose2& pose = canonical->world_T_curve;
  curve.origin = {pose.x, pose.y};
  curve.axis = {std::cos(pose.theta), std::sin(pose.theta)};
  for (const double t : fit.t) {
    curve.feet.push_back({canonical->canonical_t(t), 0.0});
  }
  return curve_of(curve) ? std::optional(std::move(curve)) : std::nullopt;
}

/// Descends with twice the digits of a double: the rounding of a vertex far away may move places by
/// more than the noise, and hide where the minimum is.
void descend_exactly(const LocalPoints& local, GivenCandidate* candidate) {
  // Newton's method takes two steps from where the polynomials' descent ends at a minimum.
  constexpr DescentEffort kFewSteps{10, 1e-8, 1e-6};
  std::vector<WeighedPoint<DoubleDouble>> points = local.exact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].weight = DoubleDouble(candidate->points[i].weight);
    points[i].normal_weight = DoubleDouble(candidate->points[i].normal_weight);
    points[i].offset = DoubleDouble(candidate->points[i].offset);
  }
  PlacedCurve<DoubleDouble> exact = exact_of(candidate->curve);
  const auto descent =
      descend(&exact, std::span<const WeighedPoint<DoubleDouble>>(points), kFewSteps,
              [](PlacedCurve<DoubleDouble>* trial) { return curve_of(*trial).has_value(); });
  candidate->curve = rounded(exact);
  candidate->cost = to_double(descent.squares.cost);
  candidate->settled = descent.settled;
}

}  // namespace

void descend_as_polynomial(const LocalPoints& local, bool noise_is_stated,
                           GivenCandidate* candidate) {
  if (candidate->curve.curve_class != CurveClass::CubicSpline || candidate->settled ||
      !(candidate->cost > 0.0) || !std::isfinite(candidate->cost)) {
    return;
  }
  WorkBudget unbounded;
  const auto curve = placed_curve(
      refine_polynomial(PolynomialModel::CubicSpline, fit_points(*candidate, noise_is_stated),
                        polynomial_of(*candidate), candidate->side, RefineEffort{}, unbounded));
  if (!curve) {
    return;
  }
  GivenCandidate there = *candidate;
  there.curve = *curve;
  descend_exactly(local, &there);
  const bool is_of_arm = there.arm == 0 || is_on_arm(there.arm, there.curve);
  const bool keeps_order =
      jumps_of(there.curve, there.points) <= jumps_of(candidate->curve, candidate->points);
  if (is_of_arm && keeps_order && (there.settled || there.cost < candidate->cost)) {
    *candidate = std::move(there);
  }
}

}  // namespace palpate
