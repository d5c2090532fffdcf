#include "core/recognition/weigh/taken_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/weigh/own_directions.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

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

/// A way, as it is compared with others. Logarithms.
struct JudgedWay {
  double measured = 0.0;    ///< of the evidence of what was measured and stated
  double weighed = 0.0;     ///< the same by the prior of the expected way
  double likelihood = 0.0;  ///< of what the candidate leaves at its optimum
};

/// By how much what is known speaks for a way against another, at least: by what was measured and
/// by the prior; and where both are of one class by what is left of them. Two walls of one class
/// that lie two radii apart differ in how probable such shapes are, which says what a part is but
/// not on which side of it a probe was.
double margin_over(const JudgedWay& way, const JudgedWay& other, bool of_one_class) {
  const double margin = std::min(way.measured - other.measured, way.weighed - other.weighed);
  return of_one_class ? std::min(margin, way.likelihood - other.likelihood) : margin;
}

}  // namespace

void take_most_probable(const SideContext& by, SidedFits* sided) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // A prior (core/README.md, "The prior"): tips that touch a part from within a bend are rare,
  // probes come from outside.
  constexpr double kInsideProbability = 0.01;
  const double log_price_of_others = log_odds(1.0 - kInsideProbability);
  // A line has no bend to be outside of.
  const auto has_bend = [](const SideChoice& choice) {
    return choice.candidate != CurveClass::Line;
  };
  // It has the tips in all bends where the expected way has them outside, or the reverse: whoever
  // says the one rules out the other.
  const auto is_ruled_out = [&](const SideChoice& choice) {
    return choice.contrary && has_bend(choice) && by.touched_from != TouchedFrom::Unknown;
  };
  const auto judged = [&](const SideChoice& choice) {
    const double of_side =
        choice.log_of_normals - (is_ruled_out(choice) ? kNegligibleLogOdds : 0.0);
    const double prior = !choice.expected && has_bend(choice) ? -log_price_of_others : 0.0;
    JudgedWay way;
    way.measured = choice.log_evidence + of_side;
    way.weighed = way.measured + prior;
    way.likelihood = choice.refined
                         ? by.likelihood.log_evidence(choice.refined->chi2, 0.0, 0.0) + of_side
                         : -kInfinity;
    return way;
  };
  sided->taken = 0;
  std::vector<JudgedWay> ways;
  for (std::size_t i = 0; i < sided->choices.size(); ++i) {
    ways.push_back(judged(sided->choices[i]));
    if (ways[i].weighed > ways[sided->taken].weighed) {
      sided->taken = i;
    }
  }
  const SideChoice& taken = sided->choice();
  const JudgedWay& way = ways[sided->taken];
  const bool has_evidence = std::isfinite(way.measured);
  // Of several without any, nothing tells one from another.
  sided->margin = has_evidence || ways.size() == 1 ? kInfinity : 0.0;
  for (std::size_t i = 0; has_evidence && i < ways.size(); ++i) {
    const SideChoice& other = sided->choices[i];
    if (i != sided->taken && std::isfinite(ways[i].measured) &&
        !are_one_way(other, taken, by.arcs.smooth.reduced)) {
      sided->margin =
          std::min(sided->margin, margin_over(way, ways[i], other.candidate == taken.candidate));
    }
  }
  // A cubic bends to both sides: what is outside of it as a whole is not told.
  const bool has_outside = (class_bit(taken.candidate) & kCubics) == 0;
  if (is_ruled_out(taken) && has_outside) {
    // The samples and what was said contradict one another: neither makes the other certain.
    sided->margin = std::min(sided->margin, 0.0);
  }
}

void take_own_directions(const SideContext& by, SidedFits* sided) {
  constexpr unsigned kConics = class_bit(CurveClass::Circle) | class_bit(CurveClass::Ellipse) |
                               class_bit(CurveClass::Hyperbola);
  const SmoothModel& smooth = by.arcs.smooth;
  SideChoice& choice = sided->choices[sided->taken];
  const bool are_swayed = has_swayed_tips(smooth);
  if (!(has_kept_tips(smooth) || are_swayed) || !choice.settled ||
      has_lone_tips(choice.reduced, smooth) || !by.work.allows()) {
    return;
  }
  // Surface points along swayed directions may have led a conic far off; of centres it is sought
  // without a search.
  std::optional<ClassFits> of_centres;
  if (are_swayed) {
    of_centres = fit_classes(smooth.reduced, by.work, nullptr, by.classes & kConics);
  }
  choice.fits = along_own_directions(std::move(choice.fits), choice.reduced, choice.sides, smooth,
                                     {of_centres ? &*of_centres : nullptr, nullptr}, by.work);
}

}  // namespace palpate
