#include "core/recognition/weigh/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/out_of_reach.h"
#include "core/recognition/samples/tips/bend_to_one_side.h"
#include "core/recognition/samples/tips/sides_on_a_cubic.h"
#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/weigh/curve_of_centres.h"
#include "core/recognition/weigh/directed_touches.h"
#include "core/recognition/weigh/fit_way.h"
#include "core/recognition/weigh/taken_way.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

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

/// A closed curve or one that bends to one side alone.
bool is_conic(CurveClass candidate) {
  return candidate != CurveClass::Line && (class_bit(candidate) & kCubics) == 0;
}

/// The ways tried so far, and what is known of the tips' directions by now.
class TriedWays {
 public:
  TriedWays(std::span<const StoredPatch> patches, const SideContext& by,
            std::span<const SidedStart> starts, CurveOfCentres* centres, DirectedTouches seen)
      : patches_(patches),
        by_(by),
        now_(by),
        starts_(starts),
        centres_(*centres),
        seen_(std::move(seen)) {
    if (seen_.told) {
      take_told(log_evidence_of_unclassified(by.likelihood, by.of_paths, by.arcs.smooth.chi2));
    }
    possible_ = possible_along(seen_.senses);
    if (by.touched_from == TouchedFrom::Inside && possible_.ways.size() > 1) {
      std::swap(possible_.ways[0], possible_.ways[1]);
    }
  }

  const std::vector<SideChoice>& choices() const { return choices_; }

  /// All ways that are possible, by what strokes show of bend and travel.
  void try_possible() { try_all(possible_.ways); }

  /// Of tips of different radii no curve of the centres tells how strokes travel, and where those
  /// that hardly bend have theirs: the ways by which the surface may lie on one curve of the third
  /// order.
  void try_on_a_cubic() {
    constexpr std::size_t kMost = 8;  // twice as many as are possible by bend and travel
    if (possible_.ways.size() > 1 && have_other_radii(seen_.touches) &&
        are_strokes(seen_.touches)) {
      const std::vector<int> known = known_sides(patches_, by_.arcs.smooth.reduced);
      try_all(sides_on_a_cubic(seen_.touches, known, kMost, by_.work));
    }
  }

  /// Whether strokes that travel against one another may lie on one side of a curve by different
  /// sides of their own travel.
  bool may_turn() const { return seen_.senses.empty() && possible_.may_be_otherwise(); }

  bool may_bend_to_one_side() const {
    return palpate::may_bend_to_one_side(seen_.touches, seen_.bends);
  }

  /// Whether any stroke bends beyond doubt.
  bool any_bends() const {
    for (std::size_t p = 0; p < seen_.touches.patches.size(); ++p) {
      if (certain_turn(seen_.touches.patch(p))) {
        return true;
      }
    }
    return false;
  }

  /// The ways that are possible where strokes travel as the curve of the centres tells.
  void try_along_centres() {
    if (const auto& curve = centres_.get()) {
      std::vector<std::vector<int>> ways =
          possible_along(senses_of(*curve, seen_.touches, by_.work)).ways;
      std::erase_if(ways, [&](const std::vector<int>& way) {
        return std::find(possible_.ways.begin(), possible_.ways.end(), way) != possible_.ways.end();
      });
      try_all(ways);
    }
  }

  /// The choice where no tips are to be removed.
  SideChoice without_tips() const {
    SideChoice choice;
    choice.sides = possible_.ways.front();
    choice.reduced = on_surface(seen_.touches, choice.sides);
    choice.fits = fit_classes_from(starts_, choice.sides, choice.reduced, by_, by_.out_of_reach);
    choice.evidences = by_.of_paths;
    return choice;
  }

  bool have_tips() const { return has_tips(seen_.touches.points); }

  std::vector<SideChoice> take() && { return std::move(choices_); }

 private:
  /// Whether any patch states its side: the others touch the same wall of a conic from there.
  bool any_side_is_known() const {
    const std::vector<int> known = known_sides(patches_, by_.arcs.smooth.reduced);
    return std::any_of(known.begin(), known.end(), [](int side) { return side != 0; });
  }

  PossibleSides possible_along(const std::vector<double>& senses) const {
    return possible_sides(patches_, seen_.touches, seen_.bends, senses, by_.work);
  }

  /// First all as they are, then those once more that no curve has and that might gain: the search
  /// of a way that is none may take all work, and a curve that all points have on one side tells
  /// the directions on the other.
  void try_all(const std::vector<std::vector<int>>& ways) {
    const std::size_t before = choices_.size();
    for (const std::vector<int>& sides : ways) {
      if (choices_.empty() || (!is_tried(sides) && !is_excluded(sides) && by_.work.allows())) {
        choices_.push_back(judged(fit_way(seen_.touches, sides, now_, starts_, centres_)));
      }
    }
    for (std::size_t i = before; i < choices_.size(); ++i) {
      SideChoice& choice = choices_[i];
      if (start_for(starts_, choice.sides) == nullptr) {
        const double of_others = highest_ - choice.log_of_normals;
        const auto parallel =
            choice.expected && choice.log_evidence < of_others ? curve_of_all() : std::nullopt;
        choice = judged(
            parallel ? fit_way_along(*parallel, std::move(choice), seen_.touches, now_, centres_)
                     : fit_way_again(std::move(choice), seen_.touches, now_, of_others, &centres_));
      }
    }
  }

  bool is_tried(const std::vector<int>& sides) const {
    return std::any_of(choices_.begin(), choices_.end(),
                       [&](const SideChoice& choice) { return choice.sides == sides; });
  }

  /// Whether it is said that tips do not lie so, and a conic that all points have agrees. (It would
  /// take a way of overwhelming evidence to speak against both; the search of one takes as much
  /// work as the first.)
  bool is_excluded(const std::vector<int>& sides) const {
    return is_against_a_bend(sides) &&
           (by_.touched_from != TouchedFrom::Unknown || any_side_is_known()) &&
           std::any_of(choices_.begin(), choices_.end(), [&](const SideChoice& choice) {
             return choice.expected && is_conic(choice.candidate) && fits_all(choice, by_);
           });
  }

  /// Whether a stroke that bends beyond doubt, or a single touch, of which the curve of all tells
  /// how it bends, has the tip on another side than expected.
  bool is_against_a_bend(const std::vector<int>& sides) const {
    const std::vector<int>& expected = possible_.ways.front();
    for (std::size_t p = 0; p < sides.size(); ++p) {
      const auto patch = seen_.touches.patch(p);
      if (sides[p] != expected[p] && (patch.size() == 1 || certain_turn(patch))) {
        return true;
      }
    }
    return false;
  }

  SideChoice judged(SideChoice choice) {
    choice.expected = choice.sides == possible_.ways.front();
    choice.contrary = possible_.ways.size() > 1 && choice.sides == possible_.ways[1];
    choice.log_of_normals = log_likelihood_of_normals(
        patches_, seen_.touches, sides_found(choice, seen_.touches, by_.arcs.smooth.reduced));
    if (fits_all(choice, by_)) {
      highest_ = std::max(highest_, choice.log_evidence + choice.log_of_normals);
      learn_directions(choice);
    }
    return choice;
  }

  /// Of a choice whose curve all points have.
  std::optional<CanonicalFit> curve_of(const SideChoice& choice) const {
    const ClassFit& settled = *choice.settled;
    return choice.refined->on_all ? to_canonical(*choice.refined, by_.arcs.data)
                                  : to_canonical(settled, points_of(settled, choice.reduced));
  }

  /// The most probable curve that all points have; nullopt if none was found so far.
  std::optional<CanonicalFit> curve_of_all() const {
    const SideChoice* best = nullptr;
    for (const SideChoice& choice : choices_) {
      if (fits_all(choice, by_) && (best == nullptr || choice.log_evidence > best->log_evidence)) {
        best = &choice;
      }
    }
    return best != nullptr ? curve_of(*best) : std::nullopt;
  }

  /// From a curve that all points have. Parallel curves have the same normals: those of the tips,
  /// whichever side they are on.
  void learn_directions(const SideChoice& choice) {
    if (now_.directions_told || !has_kept_tips(by_.arcs.smooth) || !are_strokes(seen_.touches)) {
      return;
    }
    if (const auto curve = curve_of(choice)) {
      tell_directions(*curve, by_.arcs.smooth, &seen_.touches, by_.work);
      take_told(choice.log_evidence);
    }
  }

  /// `log_evidence`: of what a class must not be hopeless beside.
  void take_told(double log_evidence) {
    now_.directions_told = true;
    now_.out_of_reach = std::min(
        by_.out_of_reach, out_of_reach(by_.arcs, seen_.touches, by_.likelihood, log_evidence));
  }

  std::span<const StoredPatch> patches_;
  const SideContext& by_;
  SideContext now_;
  std::span<const SidedStart> starts_;
  CurveOfCentres& centres_;
  DirectedTouches seen_;
  PossibleSides possible_;
  std::vector<SideChoice> choices_;
  /// log of the evidence of a way that all points have, with that of the normals.
  double highest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

SidedFits fit_over_sides(std::span<const StoredPatch> patches, const SideContext& by,
                         std::span<const SidedStart> starts) {
  CurveOfCentres centres(by, starts);
  TriedWays tried(patches, by, starts, &centres, directed_touches(patches, by, &centres));
  SidedFits sided;
  if (!tried.have_tips()) {
    sided.choices.push_back(tried.without_tips());
    return sided;
  }
  const auto any_that = [&](auto holds) {
    return std::any_of(
        tried.choices().begin(), tried.choices().end(),
        [&](const SideChoice& choice) { return fits_all(choice, by) && holds(choice); });
  };
  const bool may_turn = tried.may_turn();
  const bool turn_first = may_turn && !tried.may_bend_to_one_side();
  if (turn_first) {
    tried.try_along_centres();
  }
  if (!any_that([&](const SideChoice& choice) { return agrees(choice, by.arcs.smooth); })) {
    tried.try_possible();
  }
  // A line or a conic that all points have tells how they lie; a cubic, which turns to either side
  // and goes far away, may go through any two strokes, and an ellipse that is as thin as the tip is
  // thick has it on both sides of a line.
  const bool conics_tell = tried.any_bends();
  const auto tells_sides = [&](const SideChoice& choice) {
    return choice.candidate == CurveClass::Line || (conics_tell && is_conic(choice.candidate));
  };
  if (may_turn && !turn_first && by.work.allows() && !any_that(tells_sides)) {
    tried.try_along_centres();
  }
  if (by.work.allows() && !any_that(tells_sides)) {
    tried.try_on_a_cubic();
  }
  sided.choices = std::move(tried).take();
  sided.centres = centres.next_start();
  take_most_probable(by, &sided);
  take_own_directions(by, &sided);
  return sided;
}

bool rejudge_sides(const SideContext& by, SidedFits* sided) {
  if (!std::isfinite(sided->margin)) {
    return false;
  }
  for (SideChoice& choice : sided->choices) {
    if (choice.settled && by.work.allows()) {
      choice.evidences = by.of_paths;
      take_candidate(by, ModesOf::Prior, &choice);
    }
    choice.log_evidence = log_evidence_of(choice, by);
  }
  const std::size_t before = sided->taken;
  take_most_probable(by, sided);
  if (sided->taken == before) {
    return false;
  }
  take_own_directions(by, sided);
  return true;
}

}  // namespace palpate
