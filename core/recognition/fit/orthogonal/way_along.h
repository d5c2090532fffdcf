// The order of a stroke's feet along a curve that comes near itself.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/curves/all_feet.h"

namespace palpate {

/// Where a curve turns back in x or in y, in increasing order: it goes back on itself nowhere else.
struct TurnsBack {
  static constexpr std::size_t kMost = 4;
  std::array<double, kMost> t{};
  std::size_t count = 0;

  void add(double turn) {
    if (!std::isfinite(turn)) {
      return;
    }
    std::size_t k = count++;
    for (; k > 0 && t[k - 1] > turn; --k) {
      t[k] = t[k - 1];
    }
    t[k] = turn;
  }
};

/// A sample of a stroke, in the curve's frame.
struct StrokeSample {
  Vec2 position = Vec2::Zero();
  double weight = 0.0;  ///< of its distance
};

/// Where two branches that meet in a cusp or in a sharp bend are no farther apart than noise, the
/// nearest feet of a stroke lie now on this one and now on that, and a bend laid over the noise
/// would explain it. But a probe goes from one branch to another only past the place where they
/// meet: from one sample to the next no foot moves farther along the curve than the probe went.
/// `C`: position(t), foot_point(point).t, and all_feet(curve, point) by argument.
template <typename C>
class WayAlong {
 public:
  WayAlong(const C& curve, const TurnsBack& turns) : curve_(curve), turns_(turns) {
    for (std::size_t k = 0; k < turns_.count; ++k) {
      at_turn_[k] = curve.position(turns_.t[k]);
    }
  }

  /// Weighed squares of the distances from feet at these parameters.
  double squares_of(std::span<const StrokeSample> stroke, std::span<const double> feet) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < stroke.size(); ++i) {
      const double weight = stroke[i].weight;
      sum += weight * weight * (curve_.position(feet[i]) - stroke[i].position).squaredNorm();
    }
    return sum;
  }

  /// How often the stroke breaks that rule with feet at these parameters.
  int jumps_of(std::span<const StrokeSample> stroke, std::span<const double> feet) const {
    int count = 0;
    Place before = place_at(feet.front());
    for (std::size_t i = 1; i < feet.size(); ++i) {
      const Place now = place_at(feet[i]);
      count += jumps(before, now, stroke, i) ? 1 : 0;
      before = now;
    }
    return count;
  }

  /// The likeliest way through all the feet of each sample, by R. Bellman's recursion (1957).
  /// `of_jump`: what a jump costs, as squares of weighed distances do.
  void put_in_order(std::span<const StrokeSample> stroke, double of_jump,
                    std::span<double> feet) const {
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
      feet[i] = steps[i].place[k].t;
      k = steps[i].from[k];
    }
  }

 private:
  /// A place of a curve, and how many of its turns come before it.
  struct Place {
    double t = 0.0;
    std::size_t turns = 0;
    Vec2 position = Vec2::Zero();
  };

  /// The feet of one sample, and the best ways to them.
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

  void find_places(const StrokeSample& sample, Step* step) const {
    FootPlaces feet = all_feet(curve_, sample.position);
    if (feet.count == 0) {  // rounding hides it where three meet
      feet.add(curve_.foot_point(sample.position).t);
    }
    step->count = feet.count;
    for (std::size_t k = 0; k < feet.count; ++k) {
      step->place[k] = place_at(feet.t[k]);
      step->cost[k] =
          sample.weight * sample.weight * (step->place[k].position - sample.position).squaredNorm();
    }
  }

  /// Whether the way along the curve from one place past turns to another is longer than the probe
  /// went from sample i - 1 to i. A chord is no longer than its arc, and between turns at least 0.7
  /// of it.
  bool jumps(const Place& from, const Place& to, std::span<const StrokeSample> stroke,
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

  /// How far the probe can have gone from sample i - 1 to i: where it turned back between them, at
  /// a cusp, the step before or the one behind is as long as its way.
  static double way(std::span<const StrokeSample> stroke, std::size_t i) {
    const std::size_t first = i > 1 ? i - 2 : 0;
    const std::size_t last = std::min(i + 1, stroke.size() - 1);
    double sum = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      sum += (stroke[k + 1].position - stroke[k].position).norm();
    }
    return sum;
  }

  const C& curve_;
  TurnsBack turns_;
  std::array<Vec2, TurnsBack::kMost> at_turn_{};
};

}  // namespace palpate
