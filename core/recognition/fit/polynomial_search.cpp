#include "core/recognition/fit/polynomial_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/orthogonal/touchable.h"
#include "core/recognition/fit/spline_limits.h"
#include "core/recognition/fit/spline_pair.h"
#include "core/recognition/fit/starts/axis_fit.h"

namespace palpate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// refine_axis, the arms reassigned until they stay. Each lowers chi-square, so that none comes
/// back; what still changes after so many lies where the arms cross, as near to one as to another.
AxisFit refine_axis_and_arms(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                             AxisFit fit, int max_iterations, WorkBudget& work) {
  constexpr int kMostReassignments = 5;
  fit = refine_axis(points, std::move(fit), max_iterations, work);
  for (int i = 0; i < kMostReassignments && !fit.arms.empty() && work.allows(); ++i) {
    if (!reassign_arms(points, patches, &fit)) {
      break;
    }
    fit = refine_axis(points, std::move(fit), max_iterations, work);
  }
  return fit;
}

/// Ended in the same valley: seeds on both sides of one do.
bool is_same_valley(const AxisFit& a, const AxisFit& b) {
  return std::abs(a.chi2 - b.chi2) <= kSameChi2 * a.chi2 &&
         std::abs(std::remainder(a.theta - b.theta, 2.0 * kPi)) <= kSameAngle;
}

bool is_deeper(const AxisFit& a, const AxisFit& b) { return a.chi2 < b.chi2; }

/// Walks the valleys of all seeds on the reduced points; best first.
std::vector<AxisFit> walk(const std::vector<AxisFit>& seeds, const FitData& reduced,
                          WorkBudget& work) {
  std::vector<AxisFit> walked;
  for (const AxisFit& seed : seeds) {
    if (!work.allows()) {
      break;
    }
    AxisFit fit = refine_axis_and_arms(reduced.points, reduced.patches, seed, kMostWalked, work);
    if (std::isfinite(fit.chi2)) {
      walked.push_back(std::move(fit));
    }
  }
  std::sort(walked.begin(), walked.end(), is_deeper);
  walked.erase(std::unique(walked.begin(), walked.end(), is_same_valley), walked.end());
  return walked;
}

PolynomialFit refined(const AxisFit& walked, const FitData& reduced, double out_of_reach,
                      WorkBudget& work) {
  return refine_polynomial(walked.model, reduced.points, to_polynomial(walked, reduced.points),
                           kSurfacePoints, coarse(out_of_reach), work);
}

/// How many walked valleys are refined. Where walks end tells the deepest of a graph model, and if
/// strokes lead along the arms. Single touches may each lie on either arm: a walk, by distances
/// across the axis, then ends at several times the chi-square of what it leads to, and between two
/// valleys the data may leave the choice to the prior.
std::size_t most_refined(const std::vector<AxisFit>& walked, const FitData& reduced) {
  const bool are_touches =
      std::all_of(reduced.patches.begin(), reduced.patches.end(),
                  [](const PatchSpan& patch) { return patch.size() <= 1 || patch.is_joined; });
  const bool have_arms = !walked.empty() && !walked.front().arms.empty();
  return are_touches && have_arms ? walked.size() : std::min<std::size_t>(walked.size(), 1);
}

/// Walks the seeds; the best of them, refined on the reduced points.
std::optional<PolynomialFit> best_of(std::vector<AxisFit>* seeds, const FitData& reduced,
                                     double out_of_reach, WorkBudget& work) {
  *seeds = walk(*seeds, reduced, work);
  std::optional<PolynomialFit> best;
  const std::size_t most = most_refined(*seeds, reduced);
  for (std::size_t i = 0; i < most && (i == 0 || work.allows()); ++i) {
    PolynomialFit fit = refined((*seeds)[i], reduced, out_of_reach, work);
    if (!best || fit.chi2 < best->chi2) {
      best = std::move(fit);
    }
  }
  return best;
}

/// Of the walked semi-cubical parabolas the first that opens another way than the best, refined, if
/// both fit; nullopt if there is none such. An arc of one arm is nearly an arc of another, so that
/// noise may make the less probable one fit better.
std::optional<PolynomialFit> other_cusp_of(const std::vector<AxisFit>& walked,
                                           const std::optional<PolynomialFit>& best,
                                           const FitData& reduced, double out_of_reach,
                                           WorkBudget& work) {
  const std::size_t residuals = residual_count(reduced);
  if (!best || !fits_well(best->chi2, residuals)) {
    return std::nullopt;
  }
  // The square of t is along the axis, and across it as well; its third power is across alone.
  const Vec2 across(best->coefficients.col(3));
  const Vec2 axis =
      std::copysign(1.0, cross(Vec2(best->coefficients.col(2)), across)) * -left_of(across);
  const auto other = std::find_if(walked.begin(), walked.end(), [&](const AxisFit& fit) {
    return Vec2(std::cos(fit.theta), std::sin(fit.theta)).dot(axis) < 0.0;
  });
  if (other == walked.end() || !work.allows()) {
    return std::nullopt;
  }
  PolynomialFit fit = refined(*other, reduced, out_of_reach, work);
  return fit.chi2 <= best->chi2 + kHopelessRival ? std::optional(std::move(fit)) : std::nullopt;
}

/// The spline on the other side of c = 0.
PolynomialFit refined_twin(const AxisFit& walked, const FitData& reduced, double out_of_reach,
                           WorkBudget& work) {
  return refined(refine_axis_and_arms(reduced.points, reduced.patches,
                                      twin_of(walked, reduced.points), kMostWalked, work),
                 reduced, out_of_reach, work);
}

/// Walks the splines' valleys, and lets the other models start beside the splines found: near c = 0
/// splines come in pairs with a semi-cubical parabola between the two.
void add_relatives(const FitData& reduced, PolynomialSeeds* seeds, WorkBudget& work) {
  seeds->cubic_spline = walk(seeds->cubic_spline, reduced, work);
  for (const AxisFit& spline : seeds->cubic_spline) {
    seeds->semi_cubical_parabola.push_back(semi_cubical_near(spline, reduced.points));
  }
  if (!seeds->cubic_spline.empty()) {
    // A spline with its vertex far away is a cubical parabola along the same axis.
    seeds->cubical_parabola.push_back(
        {PolynomialModel::CubicalParabola, seeds->cubic_spline.front().theta, 0.0, {}, 0.0});
  }
}

/// Walks the valleys of the splines that the search has left. Those that are lower than `chi2`, of
/// the best that it has found, take their places among the others after the first, which is
/// refined: no more than a few are refined, and these must be the deepest of all.
void walk_more(const FitData& reduced, double chi2, PolynomialSeeds* seeds, WorkBudget& work) {
  std::vector<AxisFit> more = walk(seeds->more_splines, reduced, work);
  seeds->more_splines.clear();
  std::erase_if(more, [&](const AxisFit& fit) { return !(fit.chi2 < chi2); });
  const auto middle =
      seeds->cubic_spline.insert(seeds->cubic_spline.end(), more.begin(), more.end());
  std::inplace_merge(seeds->cubic_spline.begin() + 1, middle, seeds->cubic_spline.end(), is_deeper);
}

SplinePair fit_spline(const std::vector<AxisFit>& walked, const FitData& reduced,
                      double out_of_reach, WorkBudget& work) {
  SplinePair pair;
  const std::size_t most = most_refined(walked, reduced);
  const AxisFit* best = nullptr;
  for (std::size_t i = 0; i < most && (i == 0 || work.allows()); ++i) {
    PolynomialFit fit = refined(walked[i], reduced, out_of_reach, work);
    best = !pair.best || fit.chi2 < pair.best->chi2 ? &walked[i] : best;
    take(std::move(fit), &pair);
  }
  if (best != nullptr && work.allows()) {
    take(refined_twin(*best, reduced, out_of_reach, work), &pair);
  }
  return pair;
}

/// Between optima that the data leave nearly as probable the prior chooses, and one that was not
/// seen leaves another shape certain: where no conic fits, valleys whose walks end not far above
/// the deepest one's are refined too, and the other side of c = 0, if its walk has shown none, is
/// sought from the spline found. Of all the two best remain, each once: at their very ends, as on
/// the way one valley may look like two, and what nothing touches so takes no other's place.
void add_rivals(const FitData& reduced, double out_of_reach, PolynomialFits* fits,
                WorkBudget& work) {
  const auto& seeds = fits->seeds.cubic_spline;
  const double hopeless = std::min(out_of_reach, fits->cubic_spline->chi2 + kHopelessRival);
  const auto is_known = [&](const PolynomialFit& fit) {
    return is_same_valley(fit, *fits->cubic_spline) ||
           (fits->rival && is_same_valley(fit, *fits->rival));
  };
  std::vector<PolynomialFit> found;
  const auto keep = [&](PolynomialFit fit) {
    if (fit.chi2 < hopeless && !is_known(fit)) {
      found.push_back(std::move(fit));
    }
  };
  for (std::size_t i = 1;
       i < seeds.size() && work.allows() && seeds[i].chi2 <= seeds.front().chi2 + kHopelessRival;
       ++i) {
    keep(refined(seeds[i], reduced, hopeless, work));
  }
  if (!fits->rival || fits->rival->chi2 > hopeless) {
    if (const auto twin = twin_of(*fits->cubic_spline); twin && work.allows()) {
      keep(refine_polynomial(PolynomialModel::CubicSpline, reduced.points, *twin, kSurfacePoints,
                             coarse(hopeless), work));
    }
  }
  if (found.empty()) {
    return;
  }
  found.push_back(*fits->cubic_spline);
  if (fits->rival) {
    found.push_back(*fits->rival);
  }
  std::sort(found.begin(), found.end(),
            [](const PolynomialFit& a, const PolynomialFit& b) { return a.chi2 < b.chi2; });
  SplinePair pair;
  for (auto fit = found.begin(); fit != found.end() && !pair.rival && work.allows(); ++fit) {
    PolynomialFit there = refine_polynomial(PolynomialModel::CubicSpline, reduced.points, *fit,
                                            kSurfacePoints, kOnReducedEffort, work);
    if (is_touchable(there, reduced)) {
      take(std::move(there), &pair);
    }
  }
  if (pair.best) {
    fits->cubic_spline = std::move(pair.best);
    fits->rival = std::move(pair.rival);
  }
}

}  // namespace

PolynomialFits search_polynomials(const FitData& reduced, bool line_fits, double out_of_reach,
                                  WorkBudget& work) {
  PolynomialFits fits;
  if (!work.allows()) {
    return fits;
  }
  add_graph_seeds(reduced.points, &fits.seeds, work);
  if (line_fits) {
    add_straight_arm(reduced.points, &fits.seeds);
  } else {
    add_arm_seeds(reduced.points, reduced.patches, &fits.seeds, work);
  }
  add_relatives(reduced, &fits.seeds, work);
  // Conics start from it too.
  fits.parabola = best_of(&fits.seeds.parabola, reduced, kInfinity, work);
  fits.cubical_parabola = best_of(&fits.seeds.cubical_parabola, reduced, out_of_reach, work);
  fits.semi_cubical_parabola =
      best_of(&fits.seeds.semi_cubical_parabola, reduced, out_of_reach, work);
  fits.other_cusp = other_cusp_of(fits.seeds.semi_cubical_parabola, fits.semi_cubical_parabola,
                                  reduced, out_of_reach, work);
  SplinePair pair = fit_spline(fits.seeds.cubic_spline, reduced, out_of_reach, work);
  fits.cubic_spline = std::move(pair.best);
  fits.rival = std::move(pair.rival);
  start_spline_from_limits(reduced, kInfinity, out_of_reach, &fits, work);
  start_semi_cubical_from_spline(reduced, out_of_reach, &fits, work);
  start_cubical_from_spline(reduced, out_of_reach, &fits, work);
  return fits;
}

PolynomialFits search_parabola(const FitData& reduced, WorkBudget& work) {
  PolynomialFits fits;
  if (!work.allows()) {
    return fits;
  }
  add_graph_seeds(reduced.points, &fits.seeds, work);
  fits.parabola = best_of(&fits.seeds.parabola, reduced, kInfinity, work);
  return fits;
}

PolynomialFits follow_polynomials(const FitData& reduced, const PolynomialFits& starts,
                                  double out_of_reach, WorkBudget& work) {
  // A step or two; what was plausible goes as far as it takes to stay so, and not to need a search.
  constexpr RefineEffort kFollow{5, 1, 1e-2};
  constexpr RefineEffort kFarther{8, 1, 1e-2};
  constexpr double kPlausible = 2.0 * kNegligibleLogOdds;
  // Odds of exp(50) or more: the few points that may be added before the next search (a quarter of
  // all) do not turn them.
  constexpr double kFarOut = 100.0;
  PolynomialFits fits;
  fits.every_seed = starts.every_seed;
  const double highest_chi2 = starts.lowest_chi2 + kFarOut;
  const auto follow = [&](const std::optional<PolynomialFit>& start,
                          PolynomialModel model) -> std::optional<PolynomialFit> {
    if (!start || start->chi2 > highest_chi2) {
      work.spend(WorkKind::PolynomialRow, start ? reduced.points.size() : 0);
      return start ? std::optional(placed_on(reduced.points, *start)) : std::nullopt;
    }
    const bool was_plausible = start->chi2 <= starts.lowest_chi2 + kPlausible;
    RefineEffort effort = was_plausible ? kFarther : kFollow;
    effort.out_of_reach = out_of_reach;
    return refine_polynomial(model, reduced.points, *start, kSurfacePoints, effort, work);
  };
  fits.parabola = follow(starts.parabola, PolynomialModel::Parabola);
  fits.cubical_parabola = follow(starts.cubical_parabola, PolynomialModel::CubicalParabola);
  fits.semi_cubical_parabola =
      follow(starts.semi_cubical_parabola, PolynomialModel::SemiCubicalParabola);
  fits.other_cusp = follow(starts.other_cusp, PolynomialModel::SemiCubicalParabola);
  fits.cubic_spline = follow(starts.cubic_spline, PolynomialModel::CubicSpline);
  // Where it was: whether it is a rival, only a spline that comes out best has to ask.
  if (starts.rival && fits.cubic_spline) {
    fits.rival = placed_on(reduced.points, *starts.rival);
    if (fits.rival->chi2 < fits.cubic_spline->chi2) {
      std::swap(fits.rival, fits.cubic_spline);
    }
  }
  start_spline_from_limits(reduced, highest_chi2, out_of_reach, &fits, work);
  if (fits.cubic_spline && fits.cubic_spline->chi2 <= highest_chi2) {
    start_semi_cubical_from_spline(reduced, out_of_reach, &fits, work);
  }
  return fits;
}

void refine_every_seed(const FitData& reduced, double out_of_reach, PolynomialFits* fits,
                       WorkBudget& work) {
  // As many as bound the time of what no class fits.
  constexpr std::size_t kMostSeeds = 4;
  // Data that leave a conic possible tell no cubic from it.
  const std::size_t residuals = residual_count(reduced);
  const bool conic_fits = fits_well(fits->lowest_chi2, residuals);
  fits->every_seed = true;
  const auto improve = [&](std::optional<PolynomialFit>* best, const std::vector<AxisFit>& seeds) {
    if (!*best || seeds.empty()) {
      return;
    }
    bool touchable = is_touchable(**best, reduced);
    const auto arrived = [&] {
      return touchable && (conic_fits || fits_well((*best)->chi2, residuals));
    };
    // What can be touched so goes before what fits better.
    const auto keep = [&](PolynomialFit fit) {
      const bool better = fit.chi2 < (*best)->chi2;
      if (std::isfinite(fit.chi2) && (better || !touchable)) {
        const bool can_be = is_touchable(fit, reduced);
        if (can_be == touchable ? better : can_be) {
          *best = std::move(fit);
          touchable = can_be;
        }
      }
    };
    // The search has refined the first.
    for (std::size_t i = 1; i < std::min(seeds.size(), kMostSeeds) && !arrived() && work.allows();
         ++i) {
      keep(refined(seeds[i], reduced, out_of_reach, work));
      if (seeds[i].model == PolynomialModel::CubicSpline) {
        keep(refined_twin(seeds[i], reduced, out_of_reach, work));
      }
    }
    if (!arrived() && work.allows()) {
      keep(refine_polynomial(seeds.front().model, reduced.points, **best, kSurfacePoints,
                             thorough(out_of_reach), work));
    }
  };
  improve(&fits->parabola, fits->seeds.parabola);
  improve(&fits->cubical_parabola, fits->seeds.cubical_parabola);
  improve(&fits->semi_cubical_parabola, fits->seeds.semi_cubical_parabola);
  start_spline_from_limits(reduced, kInfinity, out_of_reach, fits, work);
  const bool nothing_fits =
      !conic_fits && fits->cubic_spline && !fits_well(fits->cubic_spline->chi2, residuals);
  if (nothing_fits && !fits->seeds.cubic_spline.empty()) {
    walk_more(reduced, fits->cubic_spline->chi2, &fits->seeds, work);
  }
  improve(&fits->cubic_spline, fits->seeds.cubic_spline);
  if (!conic_fits && fits->cubic_spline && fits_well(fits->cubic_spline->chi2, residuals)) {
    add_rivals(reduced, out_of_reach, fits, work);
  }
  start_semi_cubical_from_spline(reduced, out_of_reach, fits, work);
}

}  // namespace palpate
