#include "core/recognition/fit/orthogonal/touchable.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/orthogonal/polynomial_foot.h"

namespace palpate {
namespace {

/// Of a patch's points, as many as a bend, or a spike along the arc with its neighbours, may turn
/// round. What lets neighbours lie on opposite sides of a curve turns half of them.
constexpr std::size_t kOneIn = 10;

/// Of a few points one may: a quarter of them, where the chord of its neighbours goes round a bend
/// that is sharper than they are apart.
constexpr std::size_t kFewestWithOne = 4;

/// How far noise goes at most, in units of what the points state: six of its standard deviations.
/// It has no size there where nobody states it and no section shows it; then it is no larger than
/// what leaves as little as the fit does with a negligible probability. Of k degrees of freedom
/// chi-square is below a k with a probability of at most (a exp(1 - a))^(k / 2) (H. Chernoff,
/// 1952), which is below p for a = exp(-1 + 2 log(p) / k).
double farthest_noise(double chi2, const FitData& data) {
  constexpr double kDeviations = 6.0;
  const double dof = static_cast<double>(residual_count(data)) -
                     degrees_of_freedom(CurveClass::CubicSpline);  // the most
  const double least = dof > 0.0 ? dof * std::exp(-1.0 - 2.0 * kNegligibleLogOdds / dof) : 0.0;
  return chi2 < least ? kDeviations * std::sqrt(chi2 / least) : kDeviations;
}

/// True if so many of a patch's points that show a direction go against the others.
bool turns(std::size_t against, std::size_t points) {
  return against * kOneIn > points && !(against == 1 && points >= kFewestWithOne);
}

/// How often each of two ways was seen.
struct Ways {
  std::size_t forward = 0;
  std::size_t told = 0;

  void add(bool is_forward) {
    ++told;
    forward += is_forward ? 1 : 0;
  }
  bool disagree() const { return turns(std::min(forward, told - forward), told); }
};

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

/// Whether two points' places are so far apart that noise does not turn the direction from one to
/// the other round: it would have to be out by `farthest` of its standard deviations.
bool is_told_apart(const Vec2& a, const FitPoint& from, const Vec2& b, const FitPoint& to,
                   double farthest) {
  const double v = 1.0 / (from.inverse_sigma * from.inverse_sigma);
  const double w = 1.0 / (to.inverse_sigma * to.inverse_sigma);
  return (b - a).squaredNorm() > farthest * farthest * (v + w);
}

bool tells_direction(const FitPoint& from, const FitPoint& to, double farthest) {
  return is_told_apart(from.position, from, to.position, to, farthest);
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

Vec2 place_at(const PolynomialFit& fit, double t) {
  const auto& c = fit.coefficients;
  return c.col(0) + t * (c.col(1) + t * (c.col(2) + t * c.col(3)));
}

/// Length of a polynomial curve between two parameters, at least: by chords. Of a curve that goes
/// out and comes back on both sides of its middle, quarters see both.
double way_between(const PolynomialFit& fit, double from, double to) {
  constexpr int kParts = 4;
  double way = 0.0;
  Vec2 before = place_at(fit, from);
  for (int k = 1; k <= kParts; ++k) {
    const Vec2 place = place_at(fit, from + (to - from) * k / kParts);
    way += (place - before).norm();
    before = place;
  }
  return way;
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

namespace {

/// An arc of half a turn, by the chords of its quarters: 4 sin(pi / 8) of its own chord.
constexpr double kHalfTurn = 1.5307337294603591;

/// Whether a patch goes to and fro along the curve: from one sample to the next by more than half a
/// turn's way, time and again. About a bend a few may, which would be many of a few samples.
/// Nothing is said of tips' centres.
bool goes_to_and_fro(const PolynomialFit& fit, const FitData& data, const PatchSpan& patch) {
  if (patch.size() < 2 * kOneIn || data.points[patch.begin].offset > 0.0) {
    return false;
  }
  std::size_t astray = 0;
  for (std::size_t i = patch.begin; i + 1 < patch.end; ++i) {
    const double chord = (data.points[i + 1].position - data.points[i].position).norm();
    astray += way_between(fit, fit.t[i], fit.t[i + 1]) > kHalfTurn * chord ? 1 : 0;
  }
  return turns(astray, patch.size());
}

/// The parameters of a patch's feet.
std::vector<double> feet_of(const PolynomialFit& fit, const PatchSpan& patch) {
  return {fit.t.begin() + static_cast<std::ptrdiff_t>(patch.begin),
          fit.t.begin() + static_cast<std::ptrdiff_t>(patch.end)};
}

/// The middle of the widest gap between feet.
double widest_gap(std::vector<double> feet) {
  std::sort(feet.begin(), feet.end());
  std::size_t widest = 0;
  for (std::size_t i = 0; i + 1 < feet.size(); ++i) {
    widest = feet[i + 1] - feet[i] > feet[widest + 1] - feet[widest] ? i : widest;
  }
  return 0.5 * (feet[widest] + feet[widest + 1]);
}

/// The feet of a patch on one side of their widest gap: of the fewer, which may as well be on the
/// strand of the others, there. Where a curve crosses itself, noise puts feet on either strand.
/// nullopt if they may not. At least two points.
std::optional<std::vector<double>> feet_on_one_strand(const PolynomialFit& fit, const FitData& data,
                                                      const PatchSpan& patch) {
  std::vector<double> feet = feet_of(fit, patch);
  const double gap = widest_gap(feet);
  const auto is_beyond = [&](double t) { return t > gap; };
  const auto beyond = static_cast<std::size_t>(std::count_if(feet.begin(), feet.end(), is_beyond));
  const bool fewer_are_beyond = 2 * beyond <= feet.size();
  const auto is_of_fewer = [&](double t) { return is_beyond(t) == fewer_are_beyond; };
  const auto first = std::find_if_not(feet.begin(), feet.end(), is_of_fewer);
  const double farthest = farthest_noise(fit.chi2, data);
  double beside = *first;  // the last foot on the strand of the others
  for (std::size_t i = 0; i < feet.size(); ++i) {
    if (is_of_fewer(feet[i])) {
      const FitPoint& point = data.points[patch.begin + i];
      const PlacedPoint there = follow_foot_point(fit.coefficients, point.position, beside);
      if (is_of_fewer(there.t) ||
          std::abs(there.signed_distance) * point.inverse_sigma > farthest) {
        return std::nullopt;
      }
      feet[i] = there.t;
    }
    beside = feet[i];
  }
  return feet;
}

/// Whether a parameter runs to and fro along a patch, as samples half of it apart show, whose order
/// noise does not reverse. nullopt if there are none. Not where the probe itself does, as one that
/// trembles at its end: from one chord to the next the parameter then turns where the chord does. A
/// tip that rolls about a cusp goes on while its foot stays.
std::optional<bool> runs_to_and_fro(const PolynomialFit& fit, std::span<const double> feet,
                                    std::span<const FitPoint> points, bool are_joined,
                                    double farthest) {
  const auto stays = [&](std::size_t from, std::size_t to) {
    return points[from].offset > 0.0 &&
           !is_told_apart(place_at(fit, feet[from]), points[from], place_at(fit, feet[to]),
                          points[to], farthest);
  };
  const std::size_t lag = points.size() / 2;
  Ways along;
  Ways beside_chord;
  bool chord_is_turned = false;
  Vec2 chord_before = Vec2::Zero();
  for (std::size_t i = 0; i + lag < points.size(); ++i) {
    if (tells_direction(points[i], points[i + lag], farthest) && !stays(i, i + lag)) {
      const Vec2 chord = points[i + lag].position - points[i].position;
      chord_is_turned ^= chord.dot(chord_before) < 0.0;
      chord_before = chord;
      const bool is_forward = feet[i + lag] >= feet[i];
      along.add(is_forward);
      beside_chord.add(is_forward != chord_is_turned);
    }
  }
  if (along.told == 0) {
    return std::nullopt;
  }
  return along.disagree() && (are_joined || beside_chord.disagree());
}

/// Whether between two feet more of the curve is left out than the stroke is long, and more than
/// half a turn.
bool leaves_out_more(const PolynomialFit& fit, std::vector<double> feet, double stroke) {
  std::sort(feet.begin(), feet.end());  // where its arms are within noise, feet may be on either
  for (std::size_t i = 0; i + 1 < feet.size(); ++i) {
    const double chord = (place_at(fit, feet[i + 1]) - place_at(fit, feet[i])).norm();
    if (way_between(fit, feet[i], feet[i + 1]) > std::max(stroke, kHalfTurn * chord)) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool is_touchable(const PolynomialFit& fit, const FitData& data) {
  const double farthest = farthest_noise(fit.chi2, data);
  for (const PatchSpan& patch : data.patches) {
    const std::span<const FitPoint> points(data.points.data() + patch.begin, patch.size());
    const std::span<const double> feet(fit.t.data() + patch.begin, patch.size());
    const std::optional<bool> to_and_fro =
        runs_to_and_fro(fit, feet, points, patch.is_joined, farthest);
    if (!to_and_fro ? goes_to_and_fro(fit, data, patch) : *to_and_fro) {
      const auto on_one = to_and_fro ? feet_on_one_strand(fit, data, patch) : std::nullopt;
      if (!on_one || *runs_to_and_fro(fit, *on_one, points, patch.is_joined, farthest)) {
        return false;
      }
    }
  }
  return true;
}

bool leaps(const PolynomialFit& fit, const FitData& data) {
  return std::any_of(data.patches.begin(), data.patches.end(), [&](const PatchSpan& patch) {
    // Two samples are a chord: any way between them along a curve is longer.
    if (patch.size() < 3 || data.points[patch.begin].offset > 0.0) {
      return false;
    }
    double stroke = 0.0;
    for (std::size_t i = patch.begin; i + 1 < patch.end; ++i) {
      stroke += (data.points[i + 1].position - data.points[i].position).norm();
    }
    if (!leaves_out_more(fit, feet_of(fit, patch), stroke)) {
      return false;
    }
    const auto on_one = feet_on_one_strand(fit, data, patch);
    return !on_one || leaves_out_more(fit, *on_one, stroke);
  });
}

}  // namespace palpate
