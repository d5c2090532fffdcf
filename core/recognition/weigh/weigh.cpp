#include "core/recognition/weigh/weigh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics/negligible.h"
#include "core/recognition/coherent/coherent_moment.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/posterior/moments.h"
#include "core/recognition/posterior/out_of_reach.h"
#include "core/recognition/weigh/conic_mode.h"
#include "core/recognition/weigh/contenders.h"
#include "core/recognition/weigh/shared_deviations.h"
#include "core/recognition/weigh/sides.h"

namespace palpate {
namespace {

/// log odds that keep a class from being RECOGNIZED.
double margin_of(const WeighOptions& options) {
  return std::max(log_odds(options.recognized_probability), 0.0);
}

/// Without the classes that nobody wants and those that leave nothing over to test them with.
ClassFits testable(ClassFits fits, unsigned classes, std::size_t residuals) {
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    const bool wanted = (classes & (1U << i)) != 0;
    if (!wanted || static_cast<int>(residuals) <= degrees_of_freedom(curve_class)) {
      fits[i].reset();
    }
  }
  return fits;
}

/// Whether one class has all but what no answer depends on.
bool is_sure(const ClassProbabilities& probabilities) {
  constexpr double kElsewhere = 1e-3;
  const CurveClass best = most_probable(probabilities);
  return best != CurveClass::Unclassified &&
         probabilities[static_cast<std::size_t>(best)] > 1.0 - kElsewhere;
}

/// A class placed on all points, and its chi-square there.
struct Placed {
  CanonicalFit canonical;
  double chi2 = 0.0;
};

/// Every class of one way in which the tips may lie, the plausible ones refined on all points.
/// `no_conic`: as WarmStart's.
Contenders contending(ClassFits coarse, bool no_conic, const Ground& ground,
                      const WeighOptions& options, const Evidences& of_paths = {}) {
  const Arcs& arcs = ground.arcs;
  Contenders contenders;
  contenders.no_conic = no_conic;
  contenders.coarse = testable(std::move(coarse), options.classes, residual_count(arcs.data));
  contenders.fits = as_told(contenders.coarse, arcs.smooth);
  contenders.evidences = of_paths;
  contenders = refine_plausible(std::move(contenders), ground, margin_of(options));
  if (!is_sure(probabilities_of(contenders, ground))) {
    contenders = with_conic_mode(std::move(contenders), ground, options.classes);
  }
  return contenders;
}

/// The best class, if it was refined on all points.
std::optional<Placed> best_on_all(const Contenders& contenders, const Ground& ground) {
  const CurveClass best = best_class(contenders.fits, ground.likelihood, contenders.evidences);
  const auto& fit = contenders.fits[static_cast<std::size_t>(best)];
  auto canonical = fit && fit->on_all ? to_canonical(*fit, ground.arcs.data) : std::nullopt;
  return canonical ? std::optional(Placed{*std::move(canonical), fit->chi2}) : std::nullopt;
}

/// Shape, pose and covariance of what is not negligible, and of the best class in any case: where
/// it is out for some spikes, its residuals tell which.
/// On all points where it was refined there, otherwise on the reduced ones. `before`: a class
/// placed already.
std::array<std::optional<CanonicalFit>, 9> placed_canonically(
    const Contenders& contenders, const ClassProbabilities& probabilities, const Ground& ground,
    std::optional<Placed> before) {
  const CurveClass best = best_class(contenders.fits, ground.likelihood, contenders.evidences);
  std::array<std::optional<CanonicalFit>, 9> canonical;
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    const auto& fit = contenders.fits[i];
    if (!fit || fit->at_limit || !std::isfinite(fit->chi2) ||
        (curve_class != best && !(probabilities[i] > kNegligibleProbability))) {
      continue;
    }
    if (!fit->on_all) {
      canonical[i] = to_canonical(*contenders.coarse[i], ground.reduced);
    } else if (before && before->canonical.shape.curve_class == curve_class &&
               before->chi2 == fit->chi2) {
      canonical[i] = std::move(before->canonical);
    } else {
      canonical[i] = to_canonical(*fit, ground.arcs.data);
    }
  }
  return canonical;
}

/// The covariance of a class where one that is linear about its estimate does not hold its valley.
std::optional<ShapePoseCovariance> covariance_of_valley(const ClassEvidence& evidence,
                                                        const CanonicalFit& on_reduced,
                                                        const CanonicalFit& best,
                                                        const FitData& reduced, double inflation) {
  const auto valley = by_slices(evidence, reduced, inflation, Slices::ForMoment);
  if (!valley || valley->widest < 0) {
    return std::nullopt;
  }
  return with_bend(inflation * best.covariance, inflation * on_reduced.covariance,
                   second_moment(on_reduced, *valley, reduced));
}

/// The moment where neighbours may err together: what such deviations leave unknown, with what the
/// valley's bend adds, as far as there are any. `valley`: covariance_of_valley, if there is one;
/// `bound`: of the noise alone; `inflation`: that of `valley`; `stated`: of it, for stated form
/// error.
ShapePoseCovariance with_coherence(const CoherentMoment& coherent,
                                   const std::optional<ShapePoseCovariance>& valley,
                                   const ShapePoseCovariance& bound, double inflation,
                                   double stated) {
  const ShapePoseCovariance linear = inflation * bound;
  const ShapePoseCovariance shared = coherent.moment + stated * bound;
  const ShapePoseCovariance bent =
      valley ? bend_added(shared, linear, *valley).value_or(shared) : shared;
  return coherent.probability * bent + (1.0 - coherent.probability) * (valley ? *valley : linear);
}

/// Where all ways in which the tips may lie are to be followed from; the first is the one taken.
std::vector<SidedStart> starts_of(const SidedFits& sided, const Contenders& contenders,
                                  const Arcs& arcs) {
  std::vector<SidedStart> starts = sided.others;
  starts.insert(starts.begin(),
                {sided.sides, warm_start_from(contenders.coarse, arcs.smooth.reduced)});
  starts.front().start.no_conic = contenders.no_conic;
  return starts;
}

/// Whether a conic has been looked for with the tips on these sides, and none was near.
bool no_conic(std::span<const SidedStart> starts, const std::vector<int>& sides) {
  const WarmStart* start = start_for(starts, sides);
  return start != nullptr && start->no_conic;
}

/// What the stages say, gathered. `arcs` and `sided` are those that `ground` is of. `best_placed`:
/// the best class, if it is placed on all points already; `stated`: the law before any was seen.
Weighing told(Arcs&& arcs, SidedFits&& sided, Contenders contenders, const Ground& ground,
              const SeenDeviation& seen, const Likelihood& stated,
              std::optional<Placed> best_placed) {
  Weighing w;
  w.probabilities = probabilities_of(contenders, ground);
  w.best = most_probable(w.probabilities);
  w.margin_of_unclassified = margin_of_unclassified(contenders.fits, arcs.smooth.chi2,
                                                    ground.likelihood, contenders.evidences);
  w.rival_share = rival_share(contenders.fits, ground.likelihood, contenders.evidences);
  w.noise_inflation = seen.noise_inflation;
  w.white_variance = seen.white_variance;
  w.correlation_length = seen.correlation_length;
  w.inflation = seen.noise_inflation * seen.few_residuals + stated.coherent_variance;
  const auto b = static_cast<std::size_t>(w.best);
  const auto& best = contenders.fits[b];
  w.counted_chi2 = misfit_of(best ? best->chi2 : arcs.smooth.chi2, ground.likelihood);
  w.canonical = placed_canonically(contenders, w.probabilities, ground, std::move(best_placed));
  const auto& evidence = contenders.evidences.classes[b];
  if (const auto& on_reduced = contenders.evidences.on_reduced[b];
      evidence && on_reduced && w.canonical[b]) {
    const ShapePoseCovariance& bound = w.canonical[b]->covariance;
    w.moment =
        covariance_of_valley(*evidence, *on_reduced, *w.canonical[b], ground.reduced, w.inflation);
    if (w.moment) {
      w.white_moment = *w.moment / w.inflation;
    }
    if (seen.correlated) {
      const auto coherent =
          coherent_moment(*on_reduced, ground.reduced, stated, arcs.sigma, arcs.smooth.chi2);
      if (coherent) {
        w.coherent_deviation = std::sqrt(coherent->probability) * coherent->deviation;
        w.moment =
            with_coherence(*coherent, w.moment, bound, w.inflation, stated.coherent_variance);
      }
    }
  }
  w.starts = starts_of(sided, contenders, arcs);
  w.fits = std::move(contenders.fits);
  w.coarse = std::move(contenders.coarse);
  w.sides = std::move(sided.sides);
  w.reduced = std::move(sided.reduced);
  w.sides_margin = sided.margin;
  w.sigma = arcs.sigma;
  w.data = std::move(arcs.data);
  w.smooth = std::move(arcs.smooth);
  return w;
}

}  // namespace

Weighing weigh(FitData data, bool sigma_known, std::span<const StoredPatch> patches,
               const WeighOptions& options, std::span<const SidedStart> starts) {
  Arcs arcs = smooth_arcs(std::move(data), sigma_known);
  const Likelihood stated = likelihood_of(arcs, options.form_deviation_m);
  const Evidences of_paths = evidences_of_paths(arcs.smooth, stated);
  const double hopeless = options.unqualified_probe ? std::numeric_limits<double>::infinity()
                                                    : out_of_reach(arcs, stated, of_paths);
  SidedFits sided =
      fit_over_sides(patches, {arcs, stated, of_paths, options.classes, hopeless}, starts);
  Ground ground{arcs, sided.reduced, stated, hopeless};
  Contenders contenders =
      contending(std::move(sided.fits), no_conic(starts, sided.sides), ground, options, of_paths);
  std::optional<Placed> best_placed = best_on_all(contenders, ground);
  SeenDeviation seen = best_placed
                           ? seen_deviation(arcs, stated, best_placed->chi2, best_placed->canonical,
                                            most_probable(probabilities_of(contenders, ground)) ==
                                                CurveClass::Unclassified)
                           : SeenDeviation{};
  seen.correlated = seen.correlated || options.unqualified_probe;
  if (seen.likelihood) {
    ground.likelihood = *seen.likelihood;
    if (lie_otherwise(patches, {arcs, ground.likelihood, {}, options.classes},
                      starts_of(sided, contenders, arcs), &sided)) {
      contenders =
          contending(std::move(sided.fits), no_conic(starts, sided.sides), ground, options);
      best_placed.reset();
    } else {
      contenders = refine_plausible(std::move(contenders), ground, margin_of(options));
    }
  }
  if (seen.correlated && !seen.likelihood) {
    contenders = with_shared_deviations(std::move(contenders), ground, options.unqualified_probe,
                                        margin_of(options));
  }
  contenders = decided(std::move(contenders), ground, margin_of(options));
  return told(std::move(arcs), std::move(sided), std::move(contenders), ground, seen, stated,
              std::move(best_placed));
}

}  // namespace palpate
