#include "core/recognition/fit/polynomial_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/recognition/fit/axis_fit.h"

namespace palpate {
namespace {

constexpr int kSurfacePoints = 0;  // side: reduced points bear no tip radius

/// refine_axis, the arms reassigned until they stay.
AxisFit refine_axis_and_arms(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                             AxisFit fit, int max_iterations) {
  constexpr int kMostReassignments = 5;
  fit = refine_axis(points, std::move(fit), max_iterations);
  for (int i = 0; i < kMostReassignments && !fit.arms.empty(); ++i) {
    if (!reassign_arms(points, patches, &fit)) {
      break;
    }
    fit = refine_axis(points, std::move(fit), max_iterations);
  }
  return fit;
}

/// Walks the valleys of all seeds on the reduced points; best first.
std::vector<AxisFit> walk(const std::vector<AxisFit>& seeds, const FitData& reduced) {
  constexpr int kMostIterations = 15;
  std::vector<AxisFit> walked;
  for (const AxisFit& seed : seeds) {
    AxisFit fit = refine_axis_and_arms(reduced.points, reduced.patches, seed, kMostIterations);
    if (std::isfinite(fit.chi2)) {
      walked.push_back(std::move(fit));
    }
  }
  std::sort(walked.begin(), walked.end(),
            [](const AxisFit& a, const AxisFit& b) { return a.chi2 < b.chi2; });
  return walked;
}

/// The best of the walked seeds, refined on the reduced points.
std::optional<PolynomialFit> best_of(const std::vector<AxisFit>& seeds, const FitData& reduced) {
  const std::vector<AxisFit> walked = walk(seeds, reduced);
  if (walked.empty()) {
    return std::nullopt;
  }
  return refine_polynomial(walked.front().model, reduced.points,
                           to_polynomial(walked.front(), reduced.points), kSurfacePoints,
                           kCoarseEffort);
}

/// Walks the splines' valleys, and lets the other models start beside the splines found: near c = 0
/// splines come in pairs with a semi-cubical parabola between the two.
void add_relatives(const FitData& reduced, PolynomialSeeds* seeds) {
  seeds->cubic_spline = walk(seeds->cubic_spline, reduced);
  for (const AxisFit& spline : seeds->cubic_spline) {
    seeds->semi_cubical_parabola.push_back(semi_cubical_near(spline, reduced.points));
  }
  if (!seeds->cubic_spline.empty()) {
    // A spline with its vertex far away is a cubical parabola along the same axis.
    seeds->cubical_parabola.push_back(
        {PolynomialModel::CubicalParabola, seeds->cubic_spline.front().theta, 0.0, {}, 0.0});
  }
}

/// The best spline and the optimum on the other side of c = 0, if there is one.
struct SplinePair {
  std::optional<PolynomialFit> best;
  std::optional<PolynomialFit> rival;
};

SplinePair fit_spline(const std::vector<AxisFit>& walked, const FitData& reduced) {
  SplinePair pair;
  if (walked.empty()) {
    return pair;
  }
  constexpr int kMostIterations = 15;
  const auto refine = [&](const AxisFit& fit) {
    return refine_polynomial(fit.model, reduced.points, to_polynomial(fit, reduced.points),
                             kSurfacePoints, kCoarseEffort);
  };
  pair.best = refine(walked.front());
  pair.rival = refine(refine_axis_and_arms(
      reduced.points, reduced.patches, twin_of(walked.front(), reduced.points), kMostIterations));
  if (pair.rival->chi2 < pair.best->chi2) {
    std::swap(pair.best, pair.rival);
  }
  return pair;
}

/// The fit as it is, with the points' foot points and chi-square.
PolynomialFit placed_on(std::span<const FitPoint> points, PolynomialFit fit) {
  fit.chi2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlacedPoint placed = place_on(fit, fit.t[i], points[i].position);
    const double residual = placed.signed_distance * points[i].inverse_sigma;
    fit.t[i] = placed.t;
    fit.chi2 += residual * residual;
  }
  return fit;
}

void keep_better(std::optional<PolynomialFit>* best, PolynomialFit fit) {
  if (std::isfinite(fit.chi2) && (!*best || fit.chi2 < (*best)->chi2)) {
    *best = std::move(fit);
  }
}

/// A class can be no worse than its limits: starts from them too where it is. Limits above
/// `highest_chi2` do not matter.
void start_from_limits(const FitData& reduced, double highest_chi2, PolynomialFits* fits) {
  for (const auto* limit :
       {&fits->parabola, &fits->cubical_parabola, &fits->semi_cubical_parabola}) {
    if (*limit && (*limit)->chi2 <= highest_chi2 &&
        (!fits->cubic_spline || (*limit)->chi2 < fits->cubic_spline->chi2)) {
      PolynomialFit start = **limit;
      normalise_parameter(PolynomialModel::CubicSpline, &start);
      keep_better(&fits->cubic_spline,
                  refine_polynomial(PolynomialModel::CubicSpline, reduced.points, std::move(start),
                                    kSurfacePoints, kCoarseEffort));
    }
  }
}

}  // namespace

PolynomialFits search_polynomials(const FitData& reduced) {
  PolynomialFits fits;
  add_graph_seeds(reduced.points, &fits.seeds);
  add_arm_seeds(reduced.points, reduced.patches, &fits.seeds);
  add_relatives(reduced, &fits.seeds);
  fits.parabola = best_of(fits.seeds.parabola, reduced);
  fits.cubical_parabola = best_of(fits.seeds.cubical_parabola, reduced);
  fits.semi_cubical_parabola = best_of(fits.seeds.semi_cubical_parabola, reduced);
  SplinePair pair = fit_spline(fits.seeds.cubic_spline, reduced);
  fits.cubic_spline = std::move(pair.best);
  fits.rival = std::move(pair.rival);
  start_from_limits(reduced, std::numeric_limits<double>::infinity(), &fits);
  return fits;
}

PolynomialFits search_parabola(const FitData& reduced) {
  PolynomialFits fits;
  add_graph_seeds(reduced.points, &fits.seeds);
  fits.parabola = best_of(fits.seeds.parabola, reduced);
  return fits;
}

PolynomialFits follow_polynomials(const FitData& reduced, const PolynomialFits& starts) {
  // A step or two; what was plausible goes as far as it takes to stay so, and not to need a search.
  constexpr RefineEffort kFollow{5, 1, 1e-2};
  constexpr RefineEffort kFarther{8, 1, 1e-2};
  constexpr double kPlausible = 20.0;  // odds of exp(10)
  // Odds of exp(50) or more: the few points that may be added before the next search (a quarter of
  // all) do not turn them.
  constexpr double kFarOut = 100.0;
  PolynomialFits fits;
  fits.every_seed = starts.every_seed;
  const double highest_chi2 = starts.lowest_chi2 + kFarOut;
  const auto follow = [&](const std::optional<PolynomialFit>& start,
                          PolynomialModel model) -> std::optional<PolynomialFit> {
    if (!start || start->chi2 > highest_chi2) {
      return start ? std::optional(placed_on(reduced.points, *start)) : std::nullopt;
    }
    const bool was_plausible = start->chi2 <= starts.lowest_chi2 + kPlausible;
    return refine_polynomial(model, reduced.points, *start, kSurfacePoints,
                             was_plausible ? kFarther : kFollow);
  };
  fits.parabola = follow(starts.parabola, PolynomialModel::Parabola);
  fits.cubical_parabola = follow(starts.cubical_parabola, PolynomialModel::CubicalParabola);
  fits.semi_cubical_parabola =
      follow(starts.semi_cubical_parabola, PolynomialModel::SemiCubicalParabola);
  fits.cubic_spline = follow(starts.cubic_spline, PolynomialModel::CubicSpline);
  // Where it was: whether it is a rival, only a spline that comes out best has to ask.
  if (starts.rival && fits.cubic_spline) {
    fits.rival = placed_on(reduced.points, *starts.rival);
    if (fits.rival->chi2 < fits.cubic_spline->chi2) {
      std::swap(fits.rival, fits.cubic_spline);
    }
  }
  start_from_limits(reduced, highest_chi2, &fits);
  return fits;
}

void refine_every_seed(const FitData& reduced, PolynomialFits* fits) {
  // The search has walked every seed to its valley, best first: beyond the first ones a valley was
  // narrower than the noise only by chance. As many as bound the time of what no class fits.
  constexpr std::size_t kMostSeeds = 2;
  constexpr RefineEffort kThorough{50, 1, 1e-4};
  fits->every_seed = true;
  const auto improve = [&](std::optional<PolynomialFit>* fit, const AxisFit& seed) {
    keep_better(fit,
                refine_polynomial(seed.model, reduced.points, to_polynomial(seed, reduced.points),
                                  kSurfacePoints, kThorough));
  };
  const auto first_of = [&](const std::vector<AxisFit>& seeds) {
    return std::span(seeds).first(std::min(seeds.size(), kMostSeeds));
  };
  for (const AxisFit& seed : first_of(fits->seeds.cubic_spline)) {
    improve(&fits->cubic_spline, seed);
    improve(&fits->cubic_spline, twin_of(seed, reduced.points));
  }
  for (const AxisFit& seed : first_of(fits->seeds.semi_cubical_parabola)) {
    improve(&fits->semi_cubical_parabola, seed);
  }
  if (auto& cubic = fits->cubical_parabola) {
    keep_better(&cubic, refine_polynomial(PolynomialModel::CubicalParabola, reduced.points, *cubic,
                                          kSurfacePoints, kThorough));
  }
  if (auto& parabola = fits->parabola) {
    keep_better(&parabola, refine_polynomial(PolynomialModel::Parabola, reduced.points, *parabola,
                                             kSurfacePoints, kThorough));
  }
}

}  // namespace palpate
