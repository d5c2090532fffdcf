#include "core/recognition/given/given_reach.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/recognition/given/placed/curve_moves.h"
#include "core/recognition/given/placed/foot_parameter.h"
#include "core/recognition/given/placed/orthogonal_squares.h"

namespace palpate {
namespace {

using Step = std::array<double, kMostUnknowns>;

/// Of the rise that is asked: less is what rounding and the last step of a descent can feign.
constexpr double kNoRise = 0.01;

/// A curve with one shape parameter held, the others at their best.
struct Held {
  PlacedCurve<double> curve;
  double rise = 0.0;
  bool settled = false;
};

class Walk {
 public:
  Walk(const PlacedCurve<double>& minimum, int arm, std::span<const WeighedPoint<double>> points,
       double asked, AtLower at_lower, GivenReach* reach)
      : minimum_(minimum),
        arm_(arm),
        points_(points),
        asked_(asked),
        at_lower_(at_lower),
        n_(static_cast<std::size_t>(Unknowns(minimum.curve_class).count)),
        reach_(reach) {}

  void run() {
    PlacedCurve<double> at = minimum_;
    const Squares<double> squares = squares_about(&at, points_);
    cost_ = squares.cost;
    moves_ = unit_moves(squares.information, n_);
    const auto lower = lower_factor(in_unit_moves(squares.information, n_, moves_), n_, 0.0);
    if (!lower) {
      return;  // more bent than a double can follow; the deviations tell that by their size
    }
    for (int i = 0; i < Unknowns(minimum_.curve_class).shape; ++i) {
      Step unit{};
      unit[static_cast<std::size_t>(i)] = 1.0 / moves_[static_cast<std::size_t>(i)];
      Step along = solve(*lower, n_, unit);
      const double deviation =
          std::sqrt(along[static_cast<std::size_t>(i)] / moves_[static_cast<std::size_t>(i)]);
      if (!(deviation > 0.0) || !std::isfinite(deviation)) {
        return;
      }
      for (std::size_t k = 0; k < n_; ++k) {
        along[k] = along[k] / moves_[k] / deviation;  // by one deviation of the parameter
      }
      for (const double way : {1.0, -1.0}) {
        follow(i, way, along);
        if (reach_->lower) {
          return;
        }
      }
    }
  }

 private:
  /// `from` moved by `step`, and from there to the best with the unknown held.
  std::optional<Held> held_at(const PlacedCurve<double>& from, const Step& step,
                              int unknown) const {
    const double value = from.shape[unknown] + step[static_cast<std::size_t>(unknown)];
    GivenCandidate held;
    held.arm = arm_;
    held.curve = from;
    held.curve.move(step.data());
    // Where an ellipse's axes have changed places, another one would be held.
    if (held.curve.shape[unknown] != value) {
      return std::nullopt;
    }
    DescentEffort effort{20, 1e-4 * std::sqrt(asked_), 0.0};
    effort.held.set(unknown);
    descend_on(points_, effort, &held);
    if (!std::isfinite(held.cost) || held.curve.shape[unknown] != value) {
      return std::nullopt;
    }
    return Held{held.curve, 2.0 * (held.cost - cost_), held.settled};
  }

  void note(const Held& held) {
    ReachPoint point;
    point.step = move_between(minimum_, held.curve).step;
    // A rise of nothing has no deviation.
    point.rise = std::max(held.rise, kNoRise * asked_);
    reach_->points.push_back(point);
  }

  /// Beside a circle an ellipse of any direction is as good: the one with its axes exchanged is the
  /// farthest turned.
  void note_circle(const Held& circle) {
    // Of the rise that is asked, which three deviations have: an angle that may be any within a
    // quarter turn to either side has a variance of a third of that turn's square.
    constexpr double kAnyDirection = 1.0 / 3.0;
    ReachPoint turned;
    turned.step[static_cast<std::size_t>(Unknowns(CurveClass::Ellipse).angle)] = 0.5 * kPi;
    turned.rise = std::max(circle.rise, kAnyDirection * asked_);
    reach_->points.push_back(turned);
  }

  void follow(int unknown, double way, const Step& along) {
    const double whole = std::sqrt(asked_);
    const auto scaled = [&](const Step& step, double by) {
      Step s{};
      for (std::size_t k = 0; k < n_; ++k) {
        s[k] = by * step[k];
      }
      return s;
    };
    const auto straight = held_at(minimum_, scaled(along, way * whole), unknown);
    if (straight && straight->settled &&
        straight->rise >= asked_ / (kAlikeDeviations * kAlikeDeviations) &&
        straight->rise <= asked_ * kAlikeDeviations * kAlikeDeviations) {
      ReachPoint bend;
      bend.step = move_between(minimum_, straight->curve).step;
      for (std::size_t k = 0; k < n_; ++k) {
        bend.step[k] -= way * whole * along[k];
      }
      bend.rise = asked_;
      bend.bend = true;
      reach_->points.push_back(bend);
      return;
    }
    constexpr int kMostSteps = 40;      // growing all the way, 13 lead out of sight
    constexpr double kFirst = 0.25;     // of the way that a linear model goes
    constexpr double kLeast = 0.01;     // of that way: a shorter step means that there is no way
    constexpr double kFarthest = 64.0;  // times that way is out of sight
    constexpr double kGrowth = 1.5;     // less than by what a step too long is cut: no swinging
    Held here{minimum_, 0.0, true};
    Held lowest = here;
    Step ahead = scaled(along, way);  // for one deviation of the parameter
    double at = 0.0;
    double length = kFirst * whole;
    bool ended = false;
    bool at_circle = false;
    for (int i = 0; i < kMostSteps && at < kFarthest * whole && !ended; ++i) {
      const auto next = held_at(here.curve, scaled(ahead, length), unknown);
      const bool lost = !next || (!next->settled && next->rise > asked_);
      if (lost && length > kLeast * whole) {
        length *= 0.25;
        continue;
      }
      if (!next) {
        // An ellipse beyond the circle is one again, with its axes exchanged.
        at_circle = minimum_.curve_class == CurveClass::Ellipse &&
                    here.curve.shape[0] - here.curve.shape[1] <
                        2.0 * std::abs(ahead[static_cast<std::size_t>(unknown)]) * length;
        ended = at_circle;
        break;
      }
      ended = next->rise >= asked_ + lowest.rise;
      if (!ended || at == 0.0) {
        at += length;
        const CurveMove move = move_between(here.curve, next->curve);
        ahead = scaled(move.step, 1.0 / length);
        here = *next;
        lowest = here.rise < lowest.rise ? here : lowest;
        length *= kGrowth;
      } else {
        note(here);
        here = *next;
      }
    }
    if (at_lower_ == AtLower::Stop && lowest.rise < -kNoRise * asked_) {
      reach_->lower = lowest.curve;
      return;
    }
    note(here);
    if (at_circle) {
      note_circle(here);
    }
    reach_->bounded = reach_->bounded && ended;
  }

  const PlacedCurve<double>& minimum_;
  int arm_ = 0;
  std::span<const WeighedPoint<double>> points_;
  double asked_ = 0.0;
  AtLower at_lower_ = AtLower::Stop;
  std::size_t n_ = 0;
  GivenReach* reach_;
  double cost_ = 0.0;
  std::array<double, kMostUnknowns> moves_{};
};

/// One point for points with neighbouring feet: at the foot of the one in the middle, so that none
/// comes to lie in a gap, and as far off the curve as they are on average, with the weight of all.
/// Where a neighbouring curve passes all of them at one distance, its sum of squares over the
/// points differs from that over the means by a constant: any rise is the same.
WeighedPoint<double> mean_of(std::span<const std::size_t> neighbours, const GivenCandidate& minimum,
                             std::span<const Placement<double>> placed) {
  const PlacedCurve<double>& curve = minimum.curve;
  const std::size_t middle = neighbours[neighbours.size() / 2];
  double squares = 0.0;
  double miss = 0.0;
  double normal_squares = 0.0;
  double normal_turn = 0.0;
  for (const std::size_t i : neighbours) {
    const WeighedPoint<double>& point = minimum.points[i];
    const double square = point.weight * point.weight;
    squares += square;
    miss += square * (placed[i].distance - point.offset);
    if (compares_normals(placed[i], point)) {
      const double normal_square = point.normal_weight * point.normal_weight;
      normal_squares += normal_square;
      normal_turn += normal_square * normal_miss(curve, placed[i], point.normal);
    }
  }
  const auto in_points_frame = [&](const PlaneVector<double>& v) {
    return v.x * curve.axis + v.y * left(curve.axis);
  };
  WeighedPoint<double> mean = minimum.points[middle];
  const double distance = mean.offset + miss / squares;
  mean.position = curve.origin +
                  in_points_frame(placed[middle].foot.position + distance * placed[middle].normal);
  mean.weight = std::sqrt(squares);
  mean.normal_weight = std::sqrt(normal_squares);
  if (normal_squares > 0.0) {
    mean.normal = in_points_frame(turned(placed[middle].normal, normal_turn / normal_squares));
  }
  return mean;
}

/// The minimum with neighbours along its curve taken together, so that `most` points are left.
GivenCandidate with_fewer_points(const GivenCandidate& minimum, std::size_t most) {
  GivenCandidate fewer = minimum;
  const std::size_t count = minimum.points.size();
  std::vector<Placement<double>> placed;
  std::vector<double> t;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < count; ++i) {
    PlaneVector<double>& foot = fewer.curve.feet[i];
    placed.push_back(
        place(minimum.curve, minimum.curve.to_curve(minimum.points[i].position), &foot));
    t.push_back(t_at(minimum.curve.curve_class, foot));
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t u, std::size_t v) { return t[u] < t[v]; });
  const std::vector<PlaneVector<double>> feet = std::move(fewer.curve.feet);
  fewer.curve.feet.clear();
  fewer.points.clear();
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t first = k * count / most;
    const std::size_t last = (k + 1) * count / most;
    const auto neighbours = std::span<const std::size_t>(order).subspan(first, last - first);
    WeighedPoint<double>& mean = fewer.points.emplace_back(mean_of(neighbours, minimum, placed));
    const PlaneVector<double>& foot =
        fewer.curve.feet.emplace_back(feet[neighbours[neighbours.size() / 2]]);
    if (mean.stroke != 0) {
      // In the order of t, those of one arm follow one another along it.
      mean.stroke = foot.x < 0.0 ? 1 : 2;
    }
  }
  return fewer;
}

}  // namespace

GivenReach reach_of(const GivenCandidate& minimum, double rise, AtLower at_lower) {
  // So near one another that the distance of a neighbouring curve, which crosses the points at most
  // once per unknown, changes by about 6 / 256 of its largest from one to the next: their squares
  // of distances from the mean are then lost, less than a thousandth of all.
  constexpr std::size_t kMostPoints = 256;
  GivenReach reach;
  if (minimum.points.size() <= kMostPoints) {
    Walk(minimum.curve, minimum.arm, minimum.points, rise, at_lower, &reach).run();
    return reach;
  }
  // Their own minimum is beside that of all points by some hundredths of a deviation.
  const GivenCandidate fewer = with_fewer_points(minimum, kMostPoints);
  Walk(fewer.curve, fewer.arm, fewer.points, rise, at_lower, &reach).run();
  return reach;
}

}  // namespace palpate
