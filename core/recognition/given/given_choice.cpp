#include "core/recognition/given/given_choice.h"

#include <algorithm>
#include <utility>

#include "core/curves/curve.h"
#include "core/recognition/given/placed/foot_parameter.h"

namespace palpate {
namespace {

/// Points whose stated material (or normal) contradicts the side, minus those that agree.
int votes_against(const GivenCandidate& candidate, const LocalPoints& local,
                  std::span<const GivenPoint> points) {
  int votes = 0;
  for (std::size_t k = 0; k < local.index.size(); ++k) {
    const GivenPoint& point = points[local.index[k]];
    const Vec2 into = point.into_material.isZero() ? Vec2(-point.normal) : point.into_material;
    if (into.isZero()) {
      continue;
    }
    const auto place_of =
        curve_point(candidate.curve.curve_class, candidate.curve.shape, candidate.curve.feet[k]);
    const PlaneVector<double> local_into{inner(candidate.curve.axis, {into.x(), into.y()}),
                                         inner(left(candidate.curve.axis), {into.x(), into.y()})};
    // The tip's centre lies opposite the material.
    votes += candidate.side * inner(left(place_of.first), local_into) > 0.0 ? 1 : -1;
  }
  return votes;
}

/// By how much the touched stretch turns towards the tips' centres: above 0 if they touch from
/// inside its bend. The turn counts, not the number of touches: most of those of a corner may lie
/// on walls that bend the other way a little. [rad]
double turn_towards_tips(const GivenCandidate& candidate) {
  // Of a step between touches, which may turn by a loop that has none.
  constexpr int kParts = 8;
  const auto curve = curve_of(candidate.curve);
  if (!curve) {
    return 0.0;
  }
  std::vector<double> t;
  for (const auto& foot : candidate.curve.feet) {
    t.push_back(t_at(candidate.curve.curve_class, foot));
  }
  std::sort(t.begin(), t.end());
  const double period = domain(*curve).period;
  if (period > 0.0) {
    t = {0.0, period};  // convex all round
  }
  double turn = 0.0;
  Vec2 before = derivatives(*curve, t.front()).first;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double step = (t[i] - t[i - 1]) / kParts;
    for (int k = 1; k <= kParts; ++k) {
      const Vec2 after = derivatives(*curve, t[i - 1] + k * step).first;
      turn += turn_between(before, after);
      before = after;
    }
  }
  return candidate.side * turn;
}

/// Removes those of `open` whose mark is positive, if others have a negative one.
template <typename Mark>
void keep_told(const Mark& mark, std::vector<std::size_t>* open) {
  const bool told =
      std::any_of(open->begin(), open->end(), [&](std::size_t k) { return mark(k) < 0; });
  if (told) {
    open->erase(
        std::remove_if(open->begin(), open->end(), [&](std::size_t k) { return mark(k) > 0; }),
        open->end());
  }
}

}  // namespace

bool on_other_side(const GivenCandidate& u, const GivenCandidate& v) {
  int opposite = 0;
  for (std::size_t i = 0; i < u.curve.feet.size(); ++i) {
    const auto outward = [i](const GivenCandidate& candidate) {
      const PlacedCurve<double>& curve = candidate.curve;
      const auto foot = curve_point(curve.curve_class, curve.shape, curve.feet[i]);
      const PlaneVector<double> n = left(foot.first);
      const double side = candidate.side;
      return side * (n.x * curve.axis + n.y * left(curve.axis));
    };
    opposite += inner(outward(u), outward(v)) < 0.0 ? 1 : -1;
  }
  return opposite > 0;
}

GivenChoice choose(std::span<const GivenCandidate> minima, const LocalPoints& local,
                   std::span<const GivenPoint> points, TouchedFrom touched_from) {
  // In the order of the minima: the better ones come first.
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < minima.size(); ++k) {
    open.push_back(k);
  }
  GivenChoice choice;
  if (minima.front().side != 0) {
    keep_told([&](std::size_t k) { return votes_against(minima[k], local, points); }, &open);
    if (touched_from != TouchedFrom::Unknown) {
      const double sought = touched_from == TouchedFrom::Inside ? 1.0 : -1.0;
      keep_told([&](std::size_t k) { return -sought * turn_towards_tips(minima[k]); }, &open);
    }
  }
  choice.taken = open.front();
  const GivenCandidate& best = minima[choice.taken];
  for (const std::size_t k : open) {
    if (k == choice.taken) {
      continue;
    }
    if (best.side == 0 || !on_other_side(best, minima[k])) {
      choice.twins.push_back(k);
    } else if (!choice.other_side) {
      choice.other_side = k;
    }
  }
  // Both sides of a circle fit alike to rounding, which must not choose; probes come from outside.
  if (choice.other_side && best.curve.curve_class == CurveClass::Circle &&
      turn_towards_tips(best) > 0.0) {
    std::swap(choice.taken, *choice.other_side);
  }
  return choice;
}

}  // namespace palpate
