#include "core/recognition/fit/orthogonal/counted_in_order.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/orthogonal/way_along.h"

namespace palpate {
namespace {

/// A polynomial curve as way_along.h asks for it.
struct PolynomialBranches {
  PolynomialCoefficients coefficients;

  Vec2 position(double t) const { return position_at(coefficients, t); }
  PlacedPoint foot_point(const Vec2& point) const {
    PlacedPoint foot;
    foot.t = nearest_parameter(coefficients, point);
    return foot;
  }
};

FootPlaces all_feet(const PolynomialBranches& curve, const Vec2& point) {
  const PolynomialCoefficients& c = curve.coefficients;
  FootPlaces feet;
  visit_stationary(c, point, [&](double t) {
    const Vec2 first = first_derivative(c, t);
    const double slope =
        first.squaredNorm() + (position_at(c, t) - point).dot(second_derivative(c, t));
    if (slope > 0.0) feet.add(t);
  });
  return feet;
}

TurnsBack turns_of(const PolynomialCoefficients& c) {
  TurnsBack turns;
  for (int axis = 0; axis < 2; ++axis) {
    Polynomial<2> derivative;
    derivative << c(axis, 1), 2.0 * c(axis, 2), 3.0 * c(axis, 3);
    visit_real_roots<2>(derivative, [&](double t) { turns.add(t); });
  }
  return turns;
}

}  // namespace

PolynomialFit counted_in_order(PolynomialFit fit, const FitData& data, WorkBudget& work) {
  const PolynomialBranches curve{fit.coefficients};
  const WayAlong way(curve, turns_of(fit.coefficients));
  std::vector<StrokeSample> stroke;
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    const std::span<const FitPoint> points = data.patch(p);
    if (points.size() < 2 || points.front().offset > 0.0) {
      continue;
    }
    stroke.clear();
    for (const FitPoint& point : points) stroke.push_back({point.position, point.inverse_sigma});
    const std::span<double> feet(fit.t.data() + data.patches[p].begin, points.size());
    if (way.jumps_of(stroke, feet) == 0) {
      continue;
    }
    work.spend(WorkKind::SoughtFoot, points.size());
    const double nearest = way.squares_of(stroke, feet);
    way.put_in_order(stroke, 2.0 * kNegligibleLogOdds, feet);
    fit.chi2 += std::max(way.squares_of(stroke, feet) - nearest, 0.0);
  }
  return fit;
}

}  // namespace palpate
