#include "core/recognition/weigh/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/negligible.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/weigh/curve_of_centres.h"
#include "core/recognition/weigh/fit_way.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

/// Whether one curve that bends to one side may have all strokes: around it, by their directions,
/// each has the next and the one before on the side to which it bends, as its ends see them.
bool may_bend_to_one_side(const FitData& touches, std::span<const double> bends) {
  struct Stroke {
    PatchSpan points;
    double sense;  ///< of its travel, bending left
    double direction;
  };
  std::vector<Stroke> around;
  for (std::size_t p = 0; p < touches.patches.size(); ++p) {
    const PatchSpan& patch = touches.patches[p];
    if (patch.size() > 0) {
      const double sense = bends[p] < 0.0 ? -1.0 : 1.0;
      const Vec2 along = sense * touches.points[patch.begin + patch.size() / 2].tangent;
      around.push_back({patch, sense, std::atan2(along.y(), along.x())});
    }
  }
  std::sort(around.begin(), around.end(),
            [](const Stroke& a, const Stroke& b) { return a.direction < b.direction; });
  const auto has_inside = [&](const Stroke& stroke, const Stroke& other) {
    for (const std::size_t end : {stroke.points.begin, stroke.points.end - 1}) {
      const FitPoint& from = touches.points[end];
      const Vec2 inside = stroke.sense * left_of(from.tangent);
      for (const std::size_t i : {other.points.begin, other.points.end - 1}) {
        if (inside.dot(touches.points[i].position - from.position) < 0.0) {
          return false;
        }
      }
    }
    return true;
  };
  for (std::size_t k = 0; k < around.size(); ++k) {
    const Stroke& next = around[(k + 1) % around.size()];
    if (!has_inside(around[k], next) || !has_inside(next, around[k])) {
      return false;
    }
  }
  return true;
}

/// The reduced points with directions for those that show none, the sides to which the patches
/// bend, and how they travel along the curve of the centres where that was needed.
struct Directed {
  FitData touches;
  std::vector<double> bends;
  std::vector<double> senses;
};

/// What the tips do not show by themselves comes from the curve of their centres.
Directed directed(std::span<const StoredPatch> patches, const SmoothModel& smooth,
                  CurveOfCentres* centres, WorkBudget& work) {
  Directed result{smooth.reduced, {}, {}};
  const bool untold = has_untold_tips(smooth);
  const bool asked = untold || has_uncertain_bends(smooth, known_sides(patches, smooth.reduced));
  if (asked && work.allows()) {
    if (const auto& curve = centres->get()) {
      set_directions(DirectionsOf::UntoldPoints, *curve, smooth, &result.touches, work);
      if (work.allows()) {
        result.bends = bends_of(*curve, result.touches, work);
      }
      if (untold && work.allows()) {
        result.senses = senses_of(*curve, result.touches, work);
      }
    }
  }
  if (result.bends.empty()) {
    result.bends = turns_of(result.touches);
  }
  auto bend = result.bends.begin();
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    if (!patch.direction.isZero()) {
      *bend = patch.turn;
    }
    ++bend;
  }
  return result;
}

/// The sides on which the tips lie as the curve found has them along its own directions.
std::vector<int> sides_found(const SideChoice& choice, const FitData& touches,
                             const FitData& centres) {
  std::vector<int> sides = choice.sides;
  if (!choice.settled || choice.settled->own_points == nullptr) {
    return sides;
  }
  const FitData& surface = *choice.settled->own_points;
  for (std::size_t p = 0; p < sides.size(); ++p) {
    double to_the_left = 0.0;
    for (std::size_t i = touches.patches[p].begin; i < touches.patches[p].end; ++i) {
      to_the_left += left_of(touches.points[i].tangent)
                         .dot(centres.points[i].position - surface.points[i].position);
    }
    if (sides[p] * to_the_left < 0.0) {
      sides[p] = -sides[p];
    }
  }
  return sides;
}

/// Whether two ways have led to one: along their own directions single touches may lie otherwise
/// than along those that their sides were told by.
bool are_one_way(const SideChoice& a, const SideChoice& b, const FitData& centres) {
  if (!a.settled || !b.settled) {
    return false;
  }
  const FitData& on_a = points_of(*a.settled, a.reduced);
  const FitData& on_b = points_of(*b.settled, b.reduced);
  for (std::size_t i = 0; i < centres.points.size(); ++i) {
    const Vec2& centre = centres.points[i].position;
    if ((on_a.points[i].position - centre).dot(on_b.points[i].position - centre) < 0.0) {
      return false;
    }
  }
  return true;
}

/// The way of the highest evidence, the expected one (from outside the bends) at the odds of the
/// prior.
void take_most_probable(const SideContext& by, SidedFits* sided) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // A prior (core/README.md, "The prior"): tips that touch a part from within a bend are rare,
  // probes come from outside. It says which of the ways that the samples allow is told, not that
  // the others are excluded: the margin does without it.
  constexpr double kInsideProbability = 0.01;
  const double log_price_of_others = log_odds(1.0 - kInsideProbability);
  sided->taken = 0;
  std::vector<double> evidences;  // logarithms, by what was measured and stated
  double highest = -kInfinity;
  for (std::size_t i = 0; i < sided->choices.size(); ++i) {
    const SideChoice& choice = sided->choices[i];
    // A line has no bend to be outside of.
    const bool has_bend = choice.candidate != CurveClass::Line;
    // It has the tips in all bends where the expected way has them outside, or the reverse: whoever
    // says the one rules out the other.
    const bool ruled_out = choice.contrary && has_bend && by.touched_from != TouchedFrom::Unknown;
    evidences.push_back(choice.log_evidence + choice.log_of_normals -
                        (ruled_out ? kNegligibleLogOdds : 0.0));
    const double weighed =
        evidences[i] - (!choice.expected && has_bend ? log_price_of_others : 0.0);
    if (i == 0 || weighed > highest) {
      highest = weighed;
      sided->taken = i;
    }
  }
  double second = -kInfinity;
  for (std::size_t i = 0; i < evidences.size(); ++i) {
    if (i != sided->taken &&
        !are_one_way(sided->choices[i], sided->choice(), by.arcs.smooth.reduced)) {
      second = std::max(second, evidences[i]);
    }
  }
  sided->margin = std::isfinite(second) ? evidences[sided->taken] - second : kInfinity;
}

}  // namespace

SidedFits fit_over_sides(std::span<const StoredPatch> patches, const SideContext& by,
                         std::span<const SidedStart> starts) {
  CurveOfCentres centres(by, starts);
  const Directed seen = directed(patches, by.arcs.smooth, &centres, by.work);
  SidedFits sided;
  PossibleSides possible = possible_sides(patches, seen.touches, seen.bends, seen.senses, by.work);
  if (by.touched_from == TouchedFrom::Inside && possible.ways.size() > 1) {
    std::swap(possible.ways[0], possible.ways[1]);
  }
  if (!has_tips(seen.touches.points)) {
    SideChoice choice;
    choice.sides = possible.ways.front();
    choice.reduced = on_surface(seen.touches, choice.sides);
    choice.fits = fit_classes_from(starts, choice.sides, choice.reduced, by, by.out_of_reach);
    sided.choices.push_back(std::move(choice));
    return sided;
  }
  double highest = -std::numeric_limits<double>::infinity();
  const auto try_ways = [&](const std::vector<std::vector<int>>& ways) {
    for (const std::vector<int>& sides : ways) {
      if (!sided.choices.empty() && !by.work.allows()) {
        break;
      }
      const double by_normals = log_likelihood_of_normals(patches, seen.touches, sides);
      SideChoice choice = fit_way(seen.touches, sides, by, starts, highest - by_normals, &centres);
      choice.expected = sides == possible.ways.front();
      choice.contrary = possible.ways.size() > 1 && sides == possible.ways[1];
      choice.log_of_normals = log_likelihood_of_normals(
          patches, seen.touches, sides_found(choice, seen.touches, by.arcs.smooth.reduced));
      if (fits_all(choice, by)) {
        highest = std::max(highest, choice.log_evidence + choice.log_of_normals);
      }
      sided.choices.push_back(std::move(choice));
    }
  };
  // Strokes that travel against one another lie on one side of a curve by different sides of their
  // own travel: the curve of the centres tells.
  const bool may_turn = seen.senses.empty() && possible.may_be_otherwise();
  const auto try_ways_along = [&] {
    if (const auto& curve = centres.get()) {
      const std::vector<double> along = senses_of(*curve, seen.touches, by.work);
      std::vector<std::vector<int>> ways =
          possible_sides(patches, seen.touches, seen.bends, along, by.work).ways;
      std::erase_if(ways, [&](const std::vector<int>& way) {
        return std::find(possible.ways.begin(), possible.ways.end(), way) != possible.ways.end();
      });
      try_ways(ways);
    }
  };
  const bool at_first = may_turn && !may_bend_to_one_side(seen.touches, seen.bends);
  if (at_first) {
    try_ways_along();
  }
  if (std::none_of(sided.choices.begin(), sided.choices.end(), [&](const SideChoice& choice) {
        return fits_all(choice, by) && agrees(choice, by.arcs.smooth);
      })) {
    try_ways(possible.ways);
  }
  // A line or a conic that all points have tells how they lie; a cubic, which turns to either side
  // and goes far away, may go through any two strokes.
  if (may_turn && !at_first && by.work.allows() &&
      std::none_of(sided.choices.begin(), sided.choices.end(), [&](const SideChoice& choice) {
        return fits_all(choice, by) && (class_bit(choice.candidate) & kCubics) == 0;
      })) {
    try_ways_along();
  }
  sided.centres = centres.next_start();
  take_most_probable(by, &sided);
  return sided;
}

bool rejudge_sides(const SideContext& by, SidedFits* sided) {
  if (!std::isfinite(sided->margin)) {
    return false;
  }
  for (SideChoice& choice : sided->choices) {
    if (choice.settled && by.work.allows()) {
      choice.evidences = by.of_paths;
      take_candidate(by, &choice);
    }
    choice.log_evidence = log_evidence_of(choice, by);
  }
  const std::size_t before = sided->taken;
  take_most_probable(by, sided);
  return sided->taken != before;
}

}  // namespace palpate
