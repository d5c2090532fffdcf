#include "core/recognition/weigh/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/numerics/negligible.h"
#include "core/recognition/coherent/coherent_evidence.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/weigh/contenders.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

/// The classes followed from where they were with the tips on these sides, or sought.
ClassFits fit_classes_from(std::span<const SidedStart> starts, std::span<const int> sides,
                           const FitData& reduced, unsigned classes,
                           double out_of_reach = std::numeric_limits<double>::infinity()) {
  const WarmStart* start = start_for(starts, sides);
  if (start == nullptr) {
    return fit_classes(reduced, nullptr, classes, out_of_reach);
  }
  const PolynomialFits carried = carried_to(*start, reduced);
  return fit_classes(reduced, &carried, classes, out_of_reach);
}

/// The classes fitted for one way in which the tips may lie.
struct Way {
  ClassFits fits;
  FitData reduced;  ///< surface points
  CurveClass candidate = CurveClass::Unclassified;
  std::optional<ClassFit> settled;  ///< the candidate at its optimum on the reduced points
  std::optional<ClassFit> refined;  ///< on all points
  Evidences evidences;
};

Way way_of(ClassFits fits, FitData reduced, const Judged& by) {
  const SmoothModel& smooth = by.arcs.smooth;
  Way way;
  way.fits = std::move(fits);
  way.reduced = std::move(reduced);
  const ClassFits told = as_told(way.fits, smooth);
  way.evidences = evidences_of(told, way.fits, smooth, way.reduced, by.likelihood, by.of_paths);
  way.candidate = best_class(told, by.likelihood, way.evidences);
  if (const auto& fit = way.fits[static_cast<std::size_t>(way.candidate)]) {
    const bool may_win =
        !tells_noise(by.arcs, by.likelihood) || fits_well(fit->chi2, residual_count(way.reduced));
    way.settled = settled(*fit, way.reduced, may_win ? RivalOf::Best : RivalOf::Other);
    way.refined = refine_on_all(*way.settled, smooth, by.arcs.data);
  }
  return way;
}

/// Of chi-square: what changes odds less than tenfold.
constexpr double kAgreement = 4.6;  // 2 ln 10

/// Whether the reduced points, tips taken off, tell of the candidate what all points do: to within
/// what changes odds less than tenfold.
bool agrees(const Way& way, const SmoothModel& smooth) {
  return way.refined && std::abs(way.settled->chi2 + smooth.chi2 - way.refined->chi2) <= kAgreement;
}

/// Whether directions could be what keeps the curve found from the points.
bool directions_may_explain(const ClassFit& settled, const FitData& touches,
                            const SmoothModel& smooth) {
  // The square of a residual that noise may leave.
  constexpr double kNoise = kNegligibleDeviations * kNegligibleDeviations;
  const double noise = std::max(1.0, smooth.noise_ratio());
  double most = 0.0;
  for (const FitPoint& point : touches.points) {
    const double off = swayed_by(point, noise) * point.inverse_sigma;
    most += off * off + kNoise * noise * noise;
  }
  return settled.chi2 <= most;
}

/// log of the evidence of a way's candidate, however free-form paths fare beside it: the ways are
/// compared with one another. A part whose walls are two curves that differ by little more than
/// coherent errors may is told no better than these are known.
double log_evidence_of(const Way& way, const Judged& by) {
  const auto& [arcs, likelihood, of_paths, classes, out_of_reach] = by;
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  const auto placed = way.refined ? to_canonical(*way.settled, way.reduced) : std::nullopt;
  if (!placed) {
    return kNone;
  }
  auto evidence = way.evidences.classes[static_cast<std::size_t>(way.candidate)];
  if (!evidence) {
    evidence = evidence_of(*placed, way.reduced, likelihood.inflation());
  }
  return evidence ? log_coherent_evidence(likelihood, *evidence, *placed, way.reduced, arcs.sigma,
                                          static_cast<double>(arcs.data.points.size()),
                                          way.refined->chi2, arcs.smooth.chi2)
                  : kNone;
}

/// The curve that fits the tips' centres best, sought when it is asked for.
class CurveOfCentres {
 public:
  explicit CurveOfCentres(const Judged& by) : by_(by) {}

  /// Its points are the smooth model's reduced ones; nullopt where no class fits.
  const std::optional<CanonicalFit>& get() {
    if (!sought_) {
      sought_ = true;
      const FitData& centres = by_.arcs.smooth.reduced;
      const Way way = way_of(fit_classes(centres, nullptr, by_.classes), centres, by_);
      curve_ = way.settled ? to_canonical(*way.settled, centres) : std::nullopt;
    }
    return curve_;
  }

 private:
  const Judged& by_;
  bool sought_ = false;
  std::optional<CanonicalFit> curve_;
};

/// Directions that turn by less are settled: the surface is off by a millionth of the radius. [rad]
constexpr double kSettledTurn = 1e-3;

/// Fits with the tips on these sides of `touches`. Where points show no direction of their own, or
/// one so swayed by noise that tips taken off along it no longer lie as all points do, directions
/// come from the curve found: one that is off by an angle puts the surface off by half its square
/// times the tip's radius, so that each round squares the error.
Way fit_along(FitData touches, std::span<const int> sides, const Judged& by,
              std::span<const SidedStart> starts) {
  const SmoothModel& smooth = by.arcs.smooth;
  FitData reduced = on_surface(touches, sides);
  ClassFits fits = fit_classes_from(starts, sides, reduced, by.classes, by.out_of_reach);
  if (std::none_of(fits.begin(), fits.end(),
                   [&](const auto& fit) { return fit && fit->chi2 <= by.out_of_reach; })) {
    Way way;  // nothing that could be, whatever directions and evidence say
    way.fits = std::move(fits);
    way.reduced = std::move(reduced);
    return way;
  }
  Way way = way_of(std::move(fits), std::move(reduced), by);
  // A third of a radian leads to a millionth within three.
  constexpr int kRounds = 3;
  // Of chi-square by a round: residuals that directions leave fall with the error's square, from a
  // third of a radian to a ninth of what they were. What is not even halved they do not leave.
  constexpr double kLeastGain = 2.0;
  for (int round = 0; round < kRounds; ++round) {
    if (!way.settled || !directions_may_explain(*way.settled, touches, smooth)) {
      break;
    }
    // (a candidate that is no such curve on all points says nothing about the directions of all)
    const bool swayed = way.refined && !agrees(way, smooth);
    // On all points distances are those of the tips' centres, whatever the directions.
    const bool of_all = swayed && way.refined->chi2 < way.settled->chi2 + smooth.chi2;
    const auto curve = of_all                            ? to_canonical(*way.refined, by.arcs.data)
                       : swayed || has_kept_tips(smooth) ? to_canonical(*way.settled, way.reduced)
                                                         : std::nullopt;
    if (!curve) {
      break;
    }
    const DirectionsOf which = swayed ? DirectionsOf::AllPoints : DirectionsOf::KeptPoints;
    if (set_directions(which, *curve, smooth, &touches) < kSettledTurn) {
      break;
    }
    FitData nearer = on_surface(touches, sides);
    const PolynomialFits carried = carried_to(warm_start_from(way.fits, way.reduced), nearer);
    ClassFits again = fit_classes(nearer, &carried, by.classes);
    const double before = way.settled->chi2;
    Way next = way_of(std::move(again), std::move(nearer), by);
    if (swayed && !(next.refined && next.refined->chi2 <= way.refined->chi2 + kAgreement)) {
      break;  // led astray
    }
    way = std::move(next);
    if (way.settled && tells_noise(by.arcs, by.likelihood) &&
        way.settled->chi2 > before / kLeastGain &&
        !fits_well(way.settled->chi2, residual_count(way.reduced))) {
      break;
    }
  }
  return way;
}

/// The same; where directions led to no curve that all points have, once more along those of the
/// curve of the centres, whose normals are nearly the surface's whichever side that is on.
Way fit_way(const FitData& touches, std::span<const int> sides, const Judged& by,
            std::span<const SidedStart> starts, CurveOfCentres* centres) {
  const SmoothModel& smooth = by.arcs.smooth;
  Way way = fit_along(touches, sides, by, starts);
  if (agrees(way, smooth) || !way.settled ||
      !directions_may_explain(*way.settled, touches, smooth) || !centres->get()) {
    return way;
  }
  FitData turned = touches;
  if (set_directions(DirectionsOf::AllPoints, *centres->get(), smooth, &turned) < kSettledTurn) {
    return way;
  }
  Way again = fit_along(std::move(turned), sides, by, {});
  const bool better = again.refined && (!way.refined || again.refined->chi2 < way.refined->chi2);
  return better ? again : way;
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
                  CurveOfCentres* centres) {
  Directed result{smooth.reduced, {}, {}};
  const bool untold = has_untold_tips(smooth);
  if (untold || has_uncertain_bends(smooth)) {
    if (const auto& curve = centres->get()) {
      set_directions(DirectionsOf::UntoldPoints, *curve, smooth, &result.touches);
      result.bends = bends_of(*curve, result.touches);
      if (untold) {
        result.senses = senses_of(*curve, result.touches);
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

}  // namespace

SidedFits fit_over_sides(std::span<const StoredPatch> patches, const Judged& by,
                         std::span<const SidedStart> starts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // A prior (core/README.md, "The prior"): tips that touch a part from within a bend are rare,
  // probes come from outside; whoever touches bores states the side. Were it above the doubt that
  // RECOGNIZED leaves (0.05), nothing touched by a tip of which no side is stated could be
  // RECOGNIZED.
  constexpr double kInsideProbability = 0.01;
  CurveOfCentres centres(by);
  const auto [touches, bends, senses] = directed(patches, by.arcs.smooth, &centres);
  const auto ways = possible_sides(patches, touches, bends, senses);
  if (!has_tips(touches.points)) {
    FitData reduced = on_surface(touches, ways.front());
    ClassFits fits = fit_classes_from(starts, ways.front(), reduced, by.classes, by.out_of_reach);
    return {std::move(fits), std::move(reduced), ways.front(), kInfinity, {}};
  }
  if (ways.size() == 1) {
    Way way = fit_way(touches, ways.front(), by, starts, &centres);
    return {std::move(way.fits), std::move(way.reduced), ways.front(), kInfinity, {}};
  }
  const double log_price_of_inside = log_odds(1.0 - kInsideProbability);
  SidedFits best;
  std::vector<SidedStart> others;
  double highest = -kInfinity;
  double second = -kInfinity;
  for (const std::vector<int>& sides : ways) {
    Way way = fit_way(touches, sides, by, starts, &centres);
    const bool first = &sides == &ways.front();
    // A line has no bend to be outside of.
    const double price = first || way.candidate == CurveClass::Line ? 0.0 : log_price_of_inside;
    const double evidence = log_evidence_of(way, by) - price;
    if (first || evidence > highest) {
      if (!first) {
        others.push_back({best.sides, warm_start_from(best.fits, best.reduced)});
      }
      second = highest;
      highest = evidence;
      best = {std::move(way.fits), std::move(way.reduced), sides, 0.0, {}};
    } else {
      others.push_back({sides, warm_start_from(way.fits, way.reduced)});
      second = std::max(second, evidence);
    }
  }
  best.others = std::move(others);
  best.margin = std::isfinite(second) ? highest - second : kInfinity;
  return best;
}

bool lie_otherwise(std::span<const StoredPatch> patches, Judged by,
                   std::span<const SidedStart> starts, SidedFits* sided) {
  if (!std::isfinite(sided->margin)) {
    return false;
  }
  by.of_paths = evidences_of_paths(by.arcs.smooth, by.likelihood);
  SidedFits again = fit_over_sides(patches, by, starts);
  if (again.sides == sided->sides) {
    sided->margin = again.margin;
    return false;
  }
  *sided = std::move(again);
  return true;
}

}  // namespace palpate
