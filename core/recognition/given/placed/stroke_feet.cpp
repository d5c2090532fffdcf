#include "core/recognition/given/placed/stroke_feet.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/orthogonal/way_along.h"
#include "core/recognition/given/placed/foot_parameter.h"

namespace palpate {
namespace {

/// Adds where q2 t^2 + q1 t + q0 = 0.
void add_roots(double q2, double q1, double q0, TurnsBack* turns) {
  const double discriminant = q1 * q1 - 4.0 * q2 * q0;
  if (discriminant > 0.0) {
    const double q = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
    turns->add(q / q2);
    turns->add(q0 / q);
  }
}

TurnsBack turns_of(const CubicalParabola& curve) {
  TurnsBack turns;
  add_roots(3.0 * curve.a, 0.0, curve.c, &turns);
  return turns;
}

TurnsBack turns_of(const SemiCubicalParabola& curve) {
  TurnsBack turns;
  turns.add(0.0);
  turns.add(-2.0 * curve.b / (3.0 * curve.a));
  return turns;
}

TurnsBack turns_of(const CubicSpline& curve) {
  TurnsBack turns;
  turns.add(0.0);
  add_roots(3.0 * curve.a, 2.0 * curve.b, curve.c, &turns);
  return turns;
}

/// Calls `visit(way, stroke, feet, begin)` for each stroke without tips over a curve that
/// has turns; `begin`: its first point.
template <typename Visit>
void visit_strokes(const Curve& curve, const PlacedCurve<double>& placed,
                   std::span<const WeighedPoint<double>> points, const Visit& visit) {
  const auto visit_on = [&](const auto& cubic) {
    const WayAlong way(cubic, turns_of(cubic));
    std::vector<StrokeSample> stroke;
    std::vector<double> feet;
    for (std::size_t begin = 0; begin < points.size();) {
      std::size_t end = begin;
      bool tips = false;
      while (end < points.size() && points[end].stroke == points[begin].stroke) {
        tips = tips || points[end].offset != 0.0;
        ++end;
      }
      if (points[begin].stroke != 0 && !tips) {
        stroke.clear();
        feet.clear();
        for (std::size_t i = begin; i < end; ++i) {
          const PlaneVector<double> p = placed.to_curve(points[i].position);
          stroke.push_back({Vec2(p.x, p.y), points[i].weight});
          feet.push_back(placed.feet[i].x);
        }
        visit(way, std::span<const StrokeSample>(stroke), std::span<double>(feet), begin);
      }
      begin = end;
    }
  };
  if (const auto* graph = std::get_if<CubicalParabola>(&curve)) {
    visit_on(*graph);
  } else if (const auto* cusp = std::get_if<SemiCubicalParabola>(&curve)) {
    visit_on(*cusp);
  } else if (const auto* spline = std::get_if<CubicSpline>(&curve)) {
    visit_on(*spline);
  }
}

}  // namespace

bool put_in_order(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points) {
  const auto curve = curve_of(*placed);
  if (!curve) {
    return false;
  }
  visit_strokes(
      *curve, *placed, points, [&](const auto& way, auto stroke, auto feet, std::size_t begin) {
        if (way.jumps_of(stroke, feet) == 0) {
          return;
        }
        // Of weighed residuals. That of a stated noise is 1, however far off the curve is:
        // the likelihood counts jumps so. An unknown one is that of the residuals at the
        // feet, if the curve is near.
        const double variance = points[begin].stated ? 1.0
                                                     : way.squares_of(stroke, feet) /
                                                           static_cast<double>(stroke.size());
        way.put_in_order(stroke, 2.0 * kNegligibleLogOdds * variance, feet);
        for (std::size_t i = 0; i < feet.size(); ++i) {
          placed->feet[begin + i] = {feet[i], 0.0};
        }
      });
  return true;
}

int jumps_of(const PlacedCurve<double>& placed, std::span<const WeighedPoint<double>> points) {
  int count = 0;
  const auto curve = curve_of(placed);
  visit_strokes(*curve, placed, points, [&](const auto& way, auto stroke, auto feet, std::size_t) {
    count += way.jumps_of(stroke, feet);
  });
  return count;
}

}  // namespace palpate
