#include "core/recognition/weigh/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/curves/cubic_spline.h"
#include "core/numerics/negligible.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/weigh/curve_of_centres.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

/// Whether a way leaves no more than `chi2` on all points, by its candidate or the class that was
/// the candidate before: a class with fewer parameters always leaves more.
bool is_as_near(const SideChoice& choice, CurveClass before, double chi2, const SideContext& by) {
  if (!choice.refined) {
    return false;
  }
  if (choice.refined->chi2 <= chi2) {
    return true;
  }
  const auto& fit = choice.fits[before];
  const auto refined = fit && before != choice.candidate
                           ? refine_on_all(settled(*fit, choice.reduced, RivalOf::Other, by.work),
                                           by.arcs.smooth, by.arcs.data, kOnAllEffort, by.work)
                           : std::nullopt;
  return refined && refined->chi2 <= chi2;
}

/// Whether directions could be what keeps the settled candidate from the reduced points.
bool directions_may_explain(const SideChoice& choice, const FitData& touches,
                            const SmoothModel& smooth) {
  // What all points have without any directions is kept from the reduced ones by theirs.
  if (choice.refined && fits_well(choice.refined->chi2, static_cast<std::size_t>(smooth.points))) {
    return true;
  }
  const double noise = std::max(1.0, smooth.noise_ratio());
  double most = noise * noise * most_of_noise(static_cast<double>(residual_count(touches)));
  for (const FitPoint& point : touches.points) {
    const double off = tip_removal_error(point, noise) * point.inverse_sigma;
    most += off * off;
  }
  return choice.settled->chi2 <= most;
}

/// Directions that turn by less are settled: a touched point moves by a thousandth of the tip's
/// radius along the surface, and off it, if that is straight there, by half a millionth. [rad]
constexpr double kSettledTurn = 1e-3;

/// Lets the class of a fit in the same frame start from there, if it is a spline: wrong directions
/// make a valley of their own about its sharp bend.
void start_at(const ClassFit& fit, WarmStart* start) {
  if (fit.curve_class == CurveClass::CubicSpline) {
    start->polynomials.cubic_spline = fit.polynomial;
  }
}

/// Fits with the tips on these sides of `touches`. Where points show no direction of their own, or
/// one so swayed by noise that tips taken off along it no longer lie as all points do, directions
/// come from the curve found: one that is off by an angle puts the surface off by half its square
/// times the tip's radius, so that each round squares the error.
SideChoice fit_along(FitData touches, std::span<const int> sides, const SideContext& by,
                     std::span<const SidedStart> starts) {
  const SmoothModel& smooth = by.arcs.smooth;
  FitData reduced = on_surface(touches, sides);
  ClassFits fits = fit_classes_from(starts, sides, reduced, by, by.out_of_reach);
  if (std::none_of(fits.begin(), fits.end(),
                   [&](const auto& fit) { return fit && fit->chi2 <= by.out_of_reach; })) {
    SideChoice choice;  // nothing that could be, whatever directions and evidence say
    choice.fits = std::move(fits);
    choice.reduced = std::move(reduced);
    return choice;
  }
  SideChoice choice = choice_of(sides, std::move(fits), std::move(reduced), by);
  // A third of a radian leads to a millionth within three.
  constexpr int kRounds = 3;
  // Of chi-square by a round: residuals that directions leave fall with the error's square, from a
  // third of a radian to a ninth of what they were. What is not even halved they do not leave.
  constexpr double kLeastGain = 2.0;
  for (int round = 0; round < kRounds; ++round) {
    if (!choice.settled || !directions_may_explain(choice, touches, smooth) || !by.work.allows()) {
      break;
    }
    // (a candidate that is no such curve on all points says nothing about the directions of all)
    const bool swayed = choice.refined && !agrees(choice, smooth);
    // On all points distances are those of the tips' centres, whatever the directions.
    const bool of_all = swayed && choice.refined->chi2 < choice.settled->chi2 + smooth.chi2;
    const auto curve = of_all ? to_canonical(*choice.refined, by.arcs.data)
                       : swayed || has_kept_tips(smooth)
                           ? to_canonical(*choice.settled, choice.reduced)
                           : std::nullopt;
    if (!curve) {
      break;
    }
    const DirectionsOf which = swayed ? DirectionsOf::AllPoints : DirectionsOf::KeptPoints;
    if (set_directions(which, *curve, smooth, &touches, by.work) < kSettledTurn) {
      break;
    }
    FitData nearer = on_surface(touches, sides);
    WarmStart start = warm_start_from(choice.fits, choice.reduced);
    if (of_all) {
      start_at(*choice.refined, &start);
    }
    ClassFits again = fit_classes(nearer, by.work, &start, by.classes, by.out_of_reach);
    const double before = least_left(choice, smooth);
    SideChoice next = choice_of(sides, std::move(again), std::move(nearer), by);
    if (!agrees(next, smooth) && disagreement(next, smooth) > disagreement(choice, smooth)) {
      break;  // worse directions than before, by what all points say
    }
    if (choice.refined &&
        !is_as_near(next, choice.candidate,
                    choice.refined->chi2 + agreement(choice.refined->chi2, smooth), by)) {
      break;  // led astray
    }
    choice = std::move(next);
    const double after = least_left(choice, smooth);
    if (noise_is_known_without_class(by.arcs, by.likelihood) && after > before / kLeastGain &&
        !fits_well(after, residual_count(by.arcs.data))) {
      break;
    }
  }
  return choice;
}

/// The way with its evidence.
SideChoice judged(SideChoice choice, const SideContext& by) {
  choice.log_evidence = log_evidence_of(choice, by);
  return choice;
}

/// Whether all points have the candidate, as far as noise lets them.
bool fits_all(const SideChoice& choice, const SideContext& by) {
  return choice.refined && fits_well(choice.refined->chi2, residual_count(by.arcs.data));
}

/// Whether one curve that bends to one side may have all strokes as they travel: each has the
/// others on the side to which it bends.
bool may_bend_to_one_side(const FitData& touches, std::span<const double> bends) {
  for (std::size_t p = 0; p < touches.patches.size(); ++p) {
    for (const std::size_t end : {touches.patches[p].begin, touches.patches[p].end - 1}) {
      const FitPoint& from = touches.points[end];
      const Vec2 inside = bends[p] * left_of(from.tangent);
      for (std::size_t q = 0; q < touches.patches.size(); ++q) {
        for (std::size_t i = touches.patches[q].begin; q != p && i < touches.patches[q].end; ++i) {
          if (inside.dot(touches.points[i].position - from.position) < 0.0) {
            return false;
          }
        }
      }
    }
  }
  return true;
}

bool is_among(std::span<const SideChoice> choices, const std::vector<int>& sides) {
  return std::any_of(choices.begin(), choices.end(),
                     [&](const SideChoice& choice) { return choice.sides == sides; });
}

double largest_tip_m(const FitData& touches) {
  double largest = 0.0;
  for (const FitPoint& point : touches.points) {
    largest = std::max(largest, point.offset);
  }
  return largest * touches.scale;
}

/// The spline, or the cusp, with a bend at t = 0 that is no sharper than a circle of that radius,
/// as centres go about a corner; nullopt of other curves, and where the bend is none.
std::optional<CanonicalFit> rounded(const CanonicalFit& curve, double radius_m) {
  const double least = CubicSpline::c_of_bend(radius_m);
  const CurveClass curve_class = curve.shape.curve_class;
  const bool is_sharper = curve_class == CurveClass::SemiCubicalParabola ||
                          (curve_class == CurveClass::CubicSpline && curve.shape.values[2] < least);
  if (!is_sharper) {
    return std::nullopt;
  }
  CanonicalFit result = curve;
  result.shape.curve_class = CurveClass::CubicSpline;
  result.shape.values[2] = least;
  return result;
}

/// The way with the tips on these sides, judged. Where directions led to no curve that all points
/// have, it is fitted once more along those of the curve of the centres, whose normals are nearly
/// the surface's whichever side that is on, and then with its bend rounded: next to a corner that
/// no touch lies on, the curve of the others' centres is a cusp. What is followed has been tried
/// along these when it was sought. What is out on all points beside `highest`, the log evidence of
/// another way that all points have, need not be told better.
SideChoice fit_choice(const FitData& touches, std::span<const int> sides, const SideContext& by,
                      std::span<const SidedStart> starts, double highest, CurveOfCentres* centres) {
  const SmoothModel& smooth = by.arcs.smooth;
  SideChoice choice = judged(fit_along(touches, sides, by, starts), by);
  const auto may_gain = [&] {
    return choice.settled && directions_may_explain(choice, touches, smooth) &&
           choice.log_evidence >= highest - kNegligibleLogOdds && by.work.allows();
  };
  const auto take_along = [&](const CanonicalFit& curve, const WarmStart* start) {
    FitData turned = touches;
    if (set_directions(DirectionsOf::AllPoints, curve, smooth, &turned, by.work) < kSettledTurn) {
      return;
    }
    std::vector<SidedStart> from;
    if (start != nullptr) {
      from.push_back({{sides.begin(), sides.end()}, *start});
    }
    SideChoice again = fit_along(std::move(turned), sides, by, from);
    if (again.refined && (!choice.refined || again.refined->chi2 < choice.refined->chi2)) {
      choice = judged(std::move(again), by);
    }
  };
  if (start_for(starts, sides) != nullptr || !may_gain()) {
    return choice;
  }
  if (!agrees(choice, smooth) && centres->get()) {
    take_along(*centres->get(), centres->start());
  }
  if (has_kept_tips(smooth) && !fits_all(choice, by) && may_gain() && centres->get()) {
    if (const auto curve = rounded(*centres->get(), largest_tip_m(touches))) {
      take_along(*curve, nullptr);
    }
  }
  return choice;
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
  if ((untold || has_uncertain_bends(smooth)) && work.allows()) {
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
    second = i == sided->taken ? second : std::max(second, evidences[i]);
  }
  sided->margin = std::isfinite(second) ? evidences[sided->taken] - second : kInfinity;
}

}  // namespace

SidedFits fit_over_sides(std::span<const StoredPatch> patches, const SideContext& by,
                         std::span<const SidedStart> starts) {
  CurveOfCentres centres(by, starts);
  const auto [touches, bends, senses] = directed(patches, by.arcs.smooth, &centres, by.work);
  SidedFits sided;
  PossibleSides possible = possible_sides(patches, touches, bends, senses, by.work);
  if (by.touched_from == TouchedFrom::Inside && possible.ways.size() > 1) {
    std::swap(possible.ways[0], possible.ways[1]);
  }
  if (!has_tips(touches.points)) {
    SideChoice choice;
    choice.sides = possible.ways.front();
    choice.reduced = on_surface(touches, choice.sides);
    choice.fits = fit_classes_from(starts, choice.sides, choice.reduced, by, by.out_of_reach);
    sided.choices.push_back(std::move(choice));
    return sided;
  }
  double highest = -std::numeric_limits<double>::infinity();
  const auto try_ways = [&](const std::vector<std::vector<int>>& ways) {
    for (const std::vector<int>& sides : ways) {
      if (is_among(sided.choices, sides)) {
        continue;
      }
      if (!sided.choices.empty() && !by.work.allows()) {
        break;
      }
      const double by_normals = log_likelihood_of_normals(patches, touches, sides);
      SideChoice choice = fit_choice(touches, sides, by, starts, highest - by_normals, &centres);
      choice.sides = sides;
      choice.expected = sides == possible.ways.front();
      choice.contrary = possible.ways.size() > 1 && sides == possible.ways[1];
      choice.log_of_normals = by_normals;
      if (fits_all(choice, by)) {
        highest = std::max(highest, choice.log_evidence + by_normals);
      }
      sided.choices.push_back(std::move(choice));
    }
  };
  // Strokes that travel against one another lie on one side of a curve by different sides of their
  // own travel: the curve of the centres tells.
  const bool may_turn = senses.empty() && possible.may_be_otherwise();
  const auto try_ways_along = [&] {
    if (const auto& curve = centres.get()) {
      const std::vector<double> along = senses_of(*curve, touches, by.work);
      std::vector<std::vector<int>> ways =
          possible_sides(patches, touches, bends, along, by.work).ways;
      std::erase_if(ways, [&](const std::vector<int>& way) {
        return std::find(possible.ways.begin(), possible.ways.end(), way) != possible.ways.end();
      });
      try_ways(ways);
    }
  };
  const bool at_first = may_turn && !may_bend_to_one_side(touches, bends);
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
