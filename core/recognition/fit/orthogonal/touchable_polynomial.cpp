#include "core/recognition/fit/orthogonal/touchable.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/orthogonal/polynomial_foot.h"
#include "core/recognition/fit/orthogonal/told_ways.h"

namespace palpate {
namespace {

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

/// An arc of half a turn, by the chords of its quarters: 4 sin(pi / 8) of its own chord.
constexpr double kHalfTurn = 1.5307337294603591;

/// Whether a patch goes to and fro along the curve: from one sample to the next by more than half a
/// turn's way, time and again. About a bend a few may, which would be many of a few samples.
/// Nothing is said of tips' centres.
bool goes_to_and_fro(const PolynomialFit& fit, const FitData& data, const PatchSpan& patch) {
  if (patch.size() < 2 * kMayTurnOneIn || data.points[patch.begin].offset > 0.0) {
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
