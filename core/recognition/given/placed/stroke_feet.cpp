#include "core/recognition/given/placed/stroke_feet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "core/curves/all_feet.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/given/placed/foot_parameter.h"

namespace palpate {
namespace {

/// Where a curve turns back in x or in y, in increasing order: it goes back on itself nowhere else.
struct Turns {
  std::array<double, 3> t{};
  std::size_t count = 0;

  void add(double turn) {
    if (std::isfinite(turn)) {
      t[count++] = turn;
      std::sort(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }
  /// Those with q2 t^2 + q1 t + q0 = 0.
  void add_roots(double q2, double q1, double q0) {
    const double discriminant = q1 * q1 - 4.0 * q2 * q0;
    if (discriminant > 0.0) {
      const double q = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
      add(q / q2);
      add(q0 / q);
    }
  }
};

Turns turns_of(const CubicalParabola& curve) {
  Turns turns;
  turns.add_roots(3.0 * curve.a, 0.0, curve.c);
  return turns;
}

Turns turns_of(const SemiCubicalParabola& curve) {
  Turns turns;
  turns.add(0.0);
  turns.add(-2.0 * curve.b / (3.0 * curve.a));
  return turns;
}

Turns turns_of(const CubicSpline& curve) {
  Turns turns;
  turns.add(0.0);
  turns.add_roots(3.0 * curve.a, 2.0 * curve.b, curve.c);
  return turns;
}

/// A place of a curve, and how many of its turns come before it.
struct Place {
  double t = 0.0;
  std::size_t turns = 0;
  Vec2 position = Vec2::Zero();
};

template <typename C>
class StrokeFeet {
 public:
  StrokeFeet(const C& curve, const PlacedCurve<double>& placed)
      : curve_(curve), placed_(placed), turns_(turns_of(curve)) {
    for (std::size_t k = 0; k < turns_.count; ++k) {
      at_turn_[k] = curve.position(turns_.t[k]);
    }
  }

  int jumps_of(std::span<const WeighedPoint<double>> stroke,
               std::span<const PlaneVector<double>> feet) const {
    int count = 0;
    Place before = place_at(feet.front().x);
    for (std::size_t i = 1; i < feet.size(); ++i) {
      const Place now = place_at(feet[i].x);
      count += jumps(before, now, stroke, i) ? 1 : 0;
      before = now;
    }
    return count;
  }

  /// The likeliest way through all the feet of each point, by R. Bellman's recursion (1957).
  void put_in_order(std::span<const WeighedPoint<double>> stroke,
                    std::span<PlaneVector<double>> feet) const {
    const double of_jump = 2.0 * kNegligibleLogOdds * variance(stroke, feet);
    std::vector<Step> steps(stroke.size());
    for (std::size_t i = 0; i < stroke.size(); ++i) {
      Step& now = steps[i];
      find_places(stroke[i], &now);
      for (std::size_t k = 0; i > 0 && k < now.count; ++k) {
        const Step& before = steps[i - 1];
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < before.count; ++j) {
          const double cost =
              before.cost[j] + (jumps(before.place[j], now.place[k], stroke, i) ? of_jump : 0.0);
          if (cost < least) {
            least = cost;
            now.from[k] = j;
          }
        }
        now.cost[k] += least;
      }
    }
    const auto& costs = steps.back().cost;
    auto k = static_cast<std::size_t>(
        std::min_element(costs.begin(),
                         costs.begin() + static_cast<std::ptrdiff_t>(steps.back().count)) -
        costs.begin());
    for (std::size_t i = stroke.size(); i-- > 0;) {
      feet[i] = {steps[i].place[k].t, 0.0};
      k = steps[i].from[k];
    }
  }

 private:
  /// The feet of one point, and the best ways to them.
  struct Step {
    std::size_t count = 0;
    std::array<Place, FootPlaces::kMost> place{};
    std::array<double, FootPlaces::kMost> cost{};  ///< sum of squares, and what jumps cost
    std::array<std::size_t, FootPlaces::kMost> from{};
  };

  Place place_at(double t) const {
    Place place{t, 0, curve_.position(t)};
    while (place.turns < turns_.count && turns_.t[place.turns] < t) {
      ++place.turns;
    }
    return place;
  }

  /// Of weighed residuals. That of a stated noise is 1, however far off the curve is: the
  /// likelihood counts jumps so. An unknown one is that of the residuals at the feet, if the curve
  /// is near.
  double variance(std::span<const WeighedPoint<double>> stroke,
                  std::span<const PlaneVector<double>> feet) const {
    if (stroke.front().stated) {
      return 1.0;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < stroke.size(); ++i) {
      const PlaneVector<double> p = placed_.to_curve(stroke[i].position);
      sum += stroke[i].weight * stroke[i].weight *
             (curve_.position(feet[i].x) - Vec2(p.x, p.y)).squaredNorm();
    }
    return sum / static_cast<double>(stroke.size());
  }

  void find_places(const WeighedPoint<double>& point, Step* step) const {
    const PlaneVector<double> p = placed_.to_curve(point.position);
    FootPlaces feet = all_feet(curve_, {p.x, p.y});
    if (feet.count == 0) {  // rounding hides it where three meet
      feet.add(curve_.foot_point({p.x, p.y}).t);
    }
    step->count = feet.count;
    for (std::size_t k = 0; k < feet.count; ++k) {
      step->place[k] = place_at(feet.t[k]);
      step->cost[k] =
          point.weight * point.weight * (step->place[k].position - Vec2(p.x, p.y)).squaredNorm();
    }
  }

  /// Whether the way along the curve from one place past turns to another is longer than the probe
  /// went from point i - 1 to i. A chord is no longer than its arc, and between turns at least 0.7
  /// of it.
  bool jumps(const Place& from, const Place& to, std::span<const WeighedPoint<double>> stroke,
             std::size_t i) const {
    if (from.turns == to.turns) {
      return false;
    }
    const auto [low, high] = std::minmax(from.turns, to.turns);
    const Vec2& first = from.turns < to.turns ? from.position : to.position;
    const Vec2& last = from.turns < to.turns ? to.position : from.position;
    double length = (at_turn_[low] - first).norm() + (last - at_turn_[high - 1]).norm();
    for (std::size_t k = low + 1; k < high; ++k) {
      length += (at_turn_[k] - at_turn_[k - 1]).norm();
    }
    return length > way(stroke, i);
  }

  /// How far the probe can have gone from point i - 1 to i: where it turned back between them, at a
  /// cusp, the step before or the one behind is as long as its way.
  static double way(std::span<const WeighedPoint<double>> stroke, std::size_t i) {
    const std::size_t first = i > 1 ? i - 2 : 0;
    const std::size_t last = std::min(i + 1, stroke.size() - 1);
    double sum = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      const PlaneVector<double> step = stroke[k + 1].position - stroke[k].position;
      sum += std::sqrt(inner(step, step));
    }
    return sum;
  }

  const C& curve_;
  const PlacedCurve<double>& placed_;
  Turns turns_;
  std::array<Vec2, 3> at_turn_{};
};

/// Calls `visit(order, begin, end)` for each stroke without tips over a curve that has turns.
template <typename Visit>
void visit_strokes(const Curve& curve, const PlacedCurve<double>& placed,
                   std::span<const WeighedPoint<double>> points, const Visit& visit) {
  const auto visit_on = [&](const auto& cubic) {
    const StrokeFeet order(cubic, placed);
    for (std::size_t begin = 0; begin < points.size();) {
      std::size_t end = begin;
      bool tips = false;
      while (end < points.size() && points[end].stroke == points[begin].stroke) {
        tips = tips || points[end].offset != 0.0;
        ++end;
      }
      if (points[begin].stroke != 0 && !tips) {
        visit(order, begin, end);
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
  visit_strokes(*curve, *placed, points,
                [&](const auto& order, std::size_t begin, std::size_t end) {
                  const auto stroke = points.subspan(begin, end - begin);
                  const auto feet = std::span(placed->feet).subspan(begin, end - begin);
                  if (order.jumps_of(stroke, feet) > 0) {
                    order.put_in_order(stroke, feet);
                  }
                });
  return true;
}

int jumps_of(const PlacedCurve<double>& placed, std::span<const WeighedPoint<double>> points) {
  int count = 0;
  const auto curve = curve_of(placed);
  visit_strokes(*curve, placed, points, [&](const auto& order, std::size_t begin, std::size_t end) {
    count += order.jumps_of(points.subspan(begin, end - begin),
                            std::span(placed.feet).subspan(begin, end - begin));
  });
  return count;
}

}  // namespace palpate
