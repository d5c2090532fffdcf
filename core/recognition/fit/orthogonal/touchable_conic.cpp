#include "core/recognition/fit/orthogonal/touchable.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/orthogonal/told_ways.h"

namespace palpate {
namespace {

/// Of the polynomial, along a vector.
double quadratic_part(const ConicCoefficients& q, const Vec2& v) {
  return q[0] * v.x() * v.x() + q[1] * v.x() * v.y() + q[2] * v.y() * v.y();
}

/// On which sides of a line points have been seen.
struct SidesSeen {
  bool positive = false;
  bool negative = false;

  void add(double distance) {
    positive = positive || distance > 0.0;
    negative = negative || distance < 0.0;
  }
  bool both() const { return positive && negative; }
};

/// Whether all points lie on one branch of a hyperbola: on one side of its conjugate axis. Tips'
/// centres may be beyond that, between the branches, where their feet are not. Noise takes points
/// at the vertex of a small a beyond the axis too: where most are farther from it than noise goes,
/// these tell. (Two branches about the noise of a line have most points near the axis.)
bool on_one_branch(const ImplicitFit& fit, std::span<const FitPoint> points, double farthest) {
  const ConicCoefficients& q = fit.coefficients;
  const Vec2 centre = centre_of(q);
  // Along the real axis the polynomial changes sign from the centre outwards.
  const double at_centre = 0.5 * (q[3] * centre.x() + q[4] * centre.y()) + q[5];
  const double angle = 0.5 * std::atan2(q[1], q[0] - q[2]);
  Vec2 axis(std::cos(angle), std::sin(angle));
  if (quadratic_part(q, axis) * at_centre > 0.0) {
    axis = left_of(axis);
  }
  SidesSeen of_all;
  SidesSeen of_far;
  std::size_t far = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2& place = points[i].offset > 0.0 ? fit.feet[i] : points[i].position;
    const double along = (place - centre).dot(axis);
    of_all.add(along);
    if (std::abs(along) * points[i].inverse_sigma > farthest) {
      of_far.add(along);
      ++far;
    }
  }
  return !(2 * far >= points.size() ? of_far : of_all).both();
}

/// Two points of a patch, by their numbers in it.
struct Chord {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// The chord that shows the direction of travel at point `i` of a patch: between its nearest
/// neighbours on both sides that are far enough apart to tell it; nullopt where none are. (A smooth
/// model's tangents will not do: where a patch is no longer than its noise they turn round.)
std::optional<Chord> travel_at(std::span<const FitPoint> patch, std::size_t i, double farthest) {
  const std::size_t last = patch.size() - 1;
  for (std::size_t k = 1; k <= last; k = 2 * k) {
    const Chord chord{i - std::min(i, k), std::min(i + k, last)};
    if (tells_direction(patch[chord.from], patch[chord.to], farthest)) {
      return chord;
    }
  }
  return std::nullopt;
}

/// Whether the conic is so thick at a foot that noise does not take the point to its other side.
/// `g`: the gradient there.
bool tells_side(const ConicCoefficients& q, const Vec2& g, const FitPoint& point, double farthest) {
  // From the foot along the normal the polynomial is |g| s + a s^2.
  const double g2 = g.squaredNorm();
  return g2 * std::sqrt(g2) * point.inverse_sigma > farthest * std::abs(quadratic_part(q, g));
}

/// A conic at the foot of a point.
struct AtFoot {
  Vec2 gradient = Vec2::Zero();
  bool is_thick = false;  ///< tells_side
};

/// Whether a chord goes round a bend of the conic: from one end of it to the other the normal turns
/// by more than a right angle, and not because noise has put an end on the other side. The conic's
/// tangent between the two may then be more than a right angle from the chord, which says nothing
/// of the way that the probe went.
bool goes_round(const AtFoot& from, const AtFoot& to) {
  return from.is_thick && to.is_thick && from.gradient.dot(to.gradient) < 0.0;
}

/// On which side of the travel a conic's polynomial grows, counted. Where the probe has turned back
/// along the curve, it is that of the way it came. Joined touches do not turn back: where they go
/// to and fro, their order is wrong.
class Directions {
 public:
  explicit Directions(bool are_joined) : are_joined_(are_joined) {}

  void add(const Vec2& travel, const Vec2& gradient) {
    const bool is_left = cross(travel, gradient) >= 0.0;
    is_turned_ ^= travel.dot(last_travel_) < 0.0 && gradient.dot(last_gradient_) > 0.0;
    beside_travel_.add(is_left != is_turned_);
    if (may_have_turned_ && is_left != way_is_left_) {
      // The point before was the first of the way back.
      --points_of_way_;
      left_of_way_ -= is_left ? 1 : 0;
      has_turned_ = true;
      end_way();
      count(is_left);
      way_is_left_ = is_left;
    }
    // Round the end of a needle the travel turns as well, but the gradient with it: at most the
    // chord of one point's neighbours goes another way.
    may_have_turned_ = !are_joined_ && is_left != way_is_left_ && travel.dot(last_travel_) < 0.0 &&
                       gradient.dot(last_gradient_) > 0.0;
    way_is_left_ = may_have_turned_ ? way_is_left_ : is_left;
    count(is_left);
    last_travel_ = travel;
    last_gradient_ = gradient;
  }

  /// Whether too many go against the others, and too many against the way that the probe itself
  /// went, which may have trembled to and fro.
  bool disagree() {
    end_way();
    return turns(std::min(left_, points_ - left_), points_) &&
           (are_joined_ || beside_travel_.disagree());
  }

 private:
  void count(bool is_left) {
    ++points_of_way_;
    left_of_way_ += is_left ? 1 : 0;
  }

  /// Between turns a way of few points tells nothing, neither for the conic nor against it: a point
  /// out of order turns its neighbours round too, and where a probe goes back a little, a section's
  /// reduced points there are no more than that.
  void end_way() {
    constexpr std::size_t kFewestOfWay = 3;
    if (!has_turned_ || points_of_way_ >= kFewestOfWay) {
      points_ += points_of_way_;
      left_ += is_back_ ? points_of_way_ - left_of_way_ : left_of_way_;
    }
    points_of_way_ = left_of_way_ = 0;
    is_back_ = !is_back_;
  }

  bool are_joined_;
  Ways beside_travel_;  ///< left, of a travel that is turned back where it turned on its side
  bool is_turned_ = false;
  std::size_t left_ = 0;
  std::size_t points_ = 0;         ///< with a direction of travel
  std::size_t points_of_way_ = 0;  ///< since it last turned back
  std::size_t left_of_way_ = 0;
  bool is_back_ = false;
  bool has_turned_ = false;       ///< at least once
  bool way_is_left_ = false;      ///< at the last point that may not have turned
  bool may_have_turned_ = false;  ///< at the last point; the next one tells
  Vec2 last_travel_ = Vec2::Zero();
  Vec2 last_gradient_ = Vec2::Zero();
};

}  // namespace

bool is_touchable(const ImplicitFit& fit, const FitData& data) {
  const ConicCoefficients& q = fit.coefficients;
  const double farthest = farthest_noise(fit.chi2, data);
  if (!(discriminant(q) > 0.0 || on_one_branch(fit, data.points, farthest))) {
    return false;
  }
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    const std::span<const FitPoint> patch = data.patch(p);
    std::vector<AtFoot> feet;
    feet.reserve(patch.size());
    std::size_t thick = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const Vec2 gradient = conic_gradient(q, fit.feet[data.patches[p].begin + i]);
      feet.push_back({gradient, tells_side(q, gradient, patch[i], farthest)});
      thick += feet.back().is_thick ? 1 : 0;
    }
    Directions all(data.patches[p].is_joined);
    Directions where_thick(data.patches[p].is_joined);
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::optional<Chord> chord = travel_at(patch, i, farthest);
      if (!chord || goes_round(feet[chord->from], feet[chord->to])) {
        continue;
      }
      const Vec2 travel = patch[chord->to].position - patch[chord->from].position;
      all.add(travel, feet[i].gradient);
      if (feet[i].is_thick) {
        where_thick.add(travel, feet[i].gradient);
      }
    }
    // The ends of a needle tell no side; where most points tell none, it has none.
    if ((2 * thick >= patch.size() ? where_thick : all).disagree()) {
      return false;
    }
  }
  return true;
}

}  // namespace palpate
