#include "core/recognition/weigh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/numerics/chi_square.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/smooth/residual_correlation.h"
#include "core/recognition/smooth/stated_form_error.h"

namespace palpate {
namespace {

/// Sets the noise of points that bring none from the smooth model's residuals. Returns whether it
/// is as good as known: no smaller than rounding.
bool estimate_noise(FitData* data, SmoothModel* smooth) {
  // With too few degrees of freedom there is no estimate; what fits to a millionth of the extent is
  // then as good as exact.
  constexpr int kFewestDegrees = 4;
  constexpr double kNoEstimate = 1e-6;
  const double rounding = rounding_level(*data);
  const double estimate = smooth->dof() >= kFewestDegrees ? smooth->noise_ratio() : kNoEstimate;
  const double sigma = std::max(estimate, rounding);
  scale_noise(sigma, data, smooth);
  return estimate <= rounding;
}

double log_evidence_of(const ClassFit& fit, const Likelihood& likelihood,
                       const Evidences& evidences) {
  return log_evidence(likelihood, evidences, fit.curve_class, fit.chi2);
}

/// The class of the highest evidence, "unclassified" aside; where none has any, the one that fits
/// best.
CurveClass best_class(const ClassFits& fits, const Likelihood& likelihood,
                      const Evidences& evidences) {
  CurveClass best = CurveClass::Unclassified;
  double highest = -std::numeric_limits<double>::infinity();
  double lowest_chi2 = std::numeric_limits<double>::infinity();
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& fit = fits[static_cast<std::size_t>(curve_class)];
    if (!fit || fit->at_limit) {
      continue;
    }
    const double evidence = log_evidence_of(*fit, likelihood, evidences);
    if (evidence > highest ||
        (!std::isfinite(highest) && evidence == highest && fit->chi2 < lowest_chi2)) {
      highest = evidence;
      lowest_chi2 = fit->chi2;
      best = curve_class;
    }
  }
  return best;
}

/// Fits to the reduced points, as these tell their chi-squares of all points.
ClassFits as_told(const ClassFits& coarse, const SmoothModel& smooth) {
  ClassFits told = coarse;
  for (auto& fit : told) {
    if (fit) {
      fit->chi2 += smooth.chi2;
    }
  }
  return told;
}

/// Fits to the reduced points for the way the material lies beside the patches: where the probes do
/// not say it, the way of the highest evidence, the first (from outside the bends) at the odds of
/// the prior. Sets w->sides and w->sides_margin.
ClassFits fit_over_sides(std::span<const StoredPatch> patches, const FitData& data,
                         const Likelihood& likelihood, const RecognizerOptions& options,
                         const WarmStart* warm, Weighing* w) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Tips that touch a part from within a bend are rare: probes come from outside.
  constexpr double kInsideProbability = 0.01;
  const SmoothModel& smooth = w->smooth;
  const auto ways = possible_sides(patches, smooth.reduced);
  if (ways.size() == 1) {
    w->sides_margin = kInfinity;
    w->sides = ways.front();
    const FitData reduced = on_surface(smooth.reduced, w->sides);
    const auto starts = warm != nullptr ? std::optional(carried_to(*warm, reduced)) : std::nullopt;
    return fit_classes(reduced, starts ? &*starts : nullptr, options.classes);
  }
  const double log_price_of_inside = log_odds(1.0 - kInsideProbability);
  ClassFits best;
  double highest = -kInfinity;
  double second = -kInfinity;
  for (const std::vector<int>& sides : ways) {
    const FitData reduced = on_surface(smooth.reduced, sides);
    ClassFits fits = fit_classes(reduced, nullptr, options.classes);
    const ClassFits told = as_told(fits, smooth);
    const Evidences evidences = evidences_of(told, fits, smooth, reduced, likelihood);
    const CurveClass candidate = best_class(told, likelihood, evidences);
    const auto& fit = fits[static_cast<std::size_t>(candidate)];
    const auto refined =
        fit ? refine_on_all(settled(*fit, reduced, RivalOf::Best), smooth, data) : std::nullopt;
    const bool first = &sides == &ways.front();
    // A line has no bend to be outside of.
    const double price = first || candidate == CurveClass::Line ? 0.0 : log_price_of_inside;
    const double evidence =
        refined ? log_evidence_of(*refined, likelihood, evidences) - price : -kInfinity;
    if (first || evidence > highest) {
      second = highest;
      highest = evidence;
      best = std::move(fits);
      w->sides = sides;
    } else {
      second = std::max(second, evidence);
    }
  }
  w->sides_margin = std::isfinite(second) ? highest - second : kInfinity;
  return best;
}

/// Whether a class, as the reduced points tell its chi-square, might keep the best from being
/// RECOGNIZED. `margin`: log odds that keep it from that; `error`: by how much chi-square may be
/// lower on all points.
bool is_plausible(const ClassFit& told, double highest, double margin, double error,
                  const Likelihood& likelihood, const Evidences& evidences) {
  const double chi2 = std::max(told.chi2 - error, 0.0);
  return std::isfinite(told.chi2) &&
         log_evidence(likelihood, evidences, told.curve_class, chi2) > highest - margin;
}

/// A class that is no such curve on all points.
ClassFit out(const ClassFit& coarse) {
  ClassFit fit = coarse;
  fit.weighed = true;
  fit.chi2 = std::numeric_limits<double>::infinity();
  return fit;
}

/// A class at its very optimum on all points, from its optimum on the reduced ones.
ClassFit polished(const ClassFit& settled, const SmoothModel& smooth, const FitData& data) {
  std::optional<ClassFit> fit;
  if (!settled.rival) {
    fit = refine_on_all(settled, smooth, data, kPolishEffort);
  } else if (const auto refined = refine_on_all(settled, smooth, data)) {
    // Not at once: the rival may be on its way to the same optimum.
    fit = polish(*refined, data);
  }
  ClassFit result = fit.value_or(out(settled));
  result.polished = true;
  return result;
}

/// A class as all points see it. Where they agree with the reduced points, and did so about the
/// best (`trusted`), it is left at its optimum there; otherwise (sections bent too sharply to be
/// followed to the noise, feet on the wrong arm) it has another one, or none.
ClassFit weighed(const ClassFit& coarse, const FitData& reduced, bool trusted,
                 const SmoothModel& smooth, const FitData& data) {
  constexpr double kAgreement = 1.0;  // of chi-square: odds are right to a factor of 1.6
  if (trusted && is_what_it_says(coarse, reduced)) {
    ClassFit fit = coarse;
    fit.chi2 = chi2_on_all(coarse, smooth, data);
    fit.weighed = true;
    if (std::abs(fit.chi2 - (coarse.chi2 + smooth.chi2)) <= kAgreement) {
      return fit;
    }
  }
  return refine_on_all(coarse, smooth, data).value_or(out(coarse));
}

/// Takes w->coarse of a class to its optimum on the reduced points, unless it is there.
const ClassFit& settle(std::size_t i, RivalOf rival, const FitData& reduced, Weighing* w) {
  if (!w->fits[i]->weighed || (rival == RivalOf::Best && w->coarse[i]->rival)) {
    w->coarse[i] = settled(*w->coarse[i], reduced, rival);
  }
  return *w->coarse[i];
}

/// Ellipse and hyperbola at their limit are the parabola.
void take_limits(ClassFits* fits) {
  const auto& parabola = (*fits)[static_cast<std::size_t>(CurveClass::Parabola)];
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    auto& fit = (*fits)[static_cast<std::size_t>(curve_class)];
    if (fit && parabola && (fit->at_limit || !std::isfinite(fit->chi2))) {
      fit = parabola;
      fit->curve_class = curve_class;
      fit->at_limit = true;
    }
  }
}

/// Weighs on all points what the reduced points leave plausible, and polishes the best. The others
/// keep the chi-square that the reduced points tell. Settles w->coarse where it has to do with it.
void weigh_plausible(const FitData& data, const FitData& reduced, const Likelihood& likelihood,
                     const RecognizerOptions& options, Weighing* w) {
  // Where the smooth model itself misfits, neither it nor the reduced points can be trusted that
  // far.
  const double misfit_ratio = std::max(1.0, w->smooth.noise_ratio() * w->smooth.noise_ratio());
  const double margin = misfit_ratio * std::max(log_odds(options.recognized_probability), 0.0);
  // Sections that bend too much to be followed to the noise err by much the same for all classes:
  // twice as much as for the best, and some units of chi-square anyhow.
  constexpr double kLeastError = 4.0;
  double error = misfit_ratio * kLeastError;
  bool trusted = true;
  for (bool changed = true; changed;) {
    changed = false;
    const auto b = static_cast<std::size_t>(best_class(w->fits, likelihood, w->evidences));
    auto& best = w->fits[b];
    if (best && !best->polished) {
      const double told = best->chi2;
      best = polished(settle(b, RivalOf::Best, reduced, w), w->smooth, data);
      if (std::isfinite(best->chi2)) {
        error = std::max(error, 2.0 * (told - best->chi2));
        const double settled_chi2 = w->coarse[b]->chi2 + w->smooth.chi2;
        trusted = trusted && std::abs(settled_chi2 - best->chi2) <= misfit_ratio * kLeastError;
      }
      changed = true;
      continue;
    }
    const double highest = best ? log_evidence_of(*best, likelihood, w->evidences)
                                : -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < w->fits.size(); ++i) {
      auto& fit = w->fits[i];
      if (fit && !fit->weighed && !fit->at_limit &&
          is_plausible(*fit, highest, margin, error, likelihood, w->evidences)) {
        fit = weighed(settle(i, RivalOf::Other, reduced, w), reduced, trusted, w->smooth, data);
        changed = true;
      }
    }
  }
  take_limits(&w->fits);
}

/// Spares no effort on the models with sharp bends.
void refine_sharp_bends(const FitData& data, const FitData& reduced, Weighing* w) {
  for (const CurveClass curve_class : {CurveClass::SemiCubicalParabola, CurveClass::CubicSpline}) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (!w->coarse[i]) {
      continue;
    }
    constexpr RefineEffort kAll{};
    ClassFit start = settled(*w->coarse[i], reduced, RivalOf::Best);
    auto refined = refine_on_all(start, w->smooth, data, kAll);
    if (refined && refined->chi2 < w->fits[i]->chi2) {
      refined->polished = true;
      w->fits[i] = std::move(refined);
      w->coarse[i] = std::move(start);
    }
  }
}

/// Chi-square as a misfit is judged by it. A class that leaves less than the smooth model (which
/// cannot follow every bend) has no form error in it.
double counted(double chi2, const Likelihood& likelihood) {
  Likelihood untempered = likelihood;
  untempered.tempering = 1.0;
  return std::min(chi2, untempered.counted(chi2));
}

CurveClass most_probable(const ClassProbabilities& probabilities) {
  return static_cast<CurveClass>(std::max_element(probabilities.begin(), probabilities.end()) -
                                 probabilities.begin());
}

/// Sets w->evidences, w->probabilities and w->best, and refines it if it is not yet.
void choose_best(const FitData& data, const FitData& reduced, const Likelihood& likelihood,
                 Weighing* w) {
  while (true) {
    w->evidences = evidences_of(w->fits, w->coarse, w->smooth, reduced, likelihood, w->evidences);
    w->evidences = integrated(std::move(w->evidences), w->fits, w->coarse, w->smooth.chi2, reduced,
                              likelihood);
    w->probabilities = probabilities_of(w->fits, w->smooth.chi2, likelihood, w->evidences);
    w->best = most_probable(w->probabilities);
    const auto i = static_cast<std::size_t>(w->best);
    auto& fit = w->fits[i];
    if (!fit || fit->polished || fit->at_limit) {
      break;
    }
    fit = polished(settle(i, RivalOf::Best, reduced, w), w->smooth, data);
    take_limits(&w->fits);
  }
}

/// Shape, pose and covariance of what is not negligible.
void place_canonically(const FitData& data, const FitData& reduced, Weighing* w) {
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    constexpr double kNegligible = 1e-6;
    const auto& fit = w->fits[i];
    if (!fit || fit->at_limit || !std::isfinite(fit->chi2) || w->canonical[i] ||
        !(w->probabilities[i] > kNegligible)) {
      continue;
    }
    if (fit->on_all) {
      w->canonical[i] = to_canonical(*fit, data);
    } else {
      w->canonical[i] = to_canonical(*w->coarse[i], reduced);
    }
  }
}

}  // namespace

Weighing weigh(FitData data, bool sigma_known, std::span<const StoredPatch> patches,
               const RecognizerOptions& options, const WarmStart* warm) {
  Weighing w;
  w.smooth = fit_smooth_model(&data, sigma_known);
  if (!sigma_known) {
    sigma_known = estimate_noise(&data, &w.smooth);
  }
  const double n = static_cast<double>(data.points.size());
  Likelihood likelihood;
  likelihood.sigma_known = sigma_known;
  likelihood.samples = n;
  // Residuals below the rounding of the coordinates say nothing.
  w.sigma = rms_sigma(data);
  const double rounding = rounding_level(data) / w.sigma;
  likelihood.chi2_floor = sigma_known ? 0.0 : n * rounding * rounding;
  const double stated = coherent_variance(data, options.form_deviation_m / data.scale);
  likelihood.coherent_variance = stated;
  likelihood.noise_chi2 = w.smooth.chi2;

  w.coarse = fit_over_sides(patches, data, likelihood, options, warm, &w);
  for (const CurveClass curve_class : kCurveClasses) {
    // A class must leave something over to test it with.
    const auto i = static_cast<std::size_t>(curve_class);
    const bool wanted = (options.classes & (1U << i)) != 0;
    if (!wanted || static_cast<int>(data.points.size()) <= degrees_of_freedom(curve_class)) {
      w.coarse[i].reset();
    }
  }
  w.fits = as_told(w.coarse, w.smooth);
  const FitData reduced = on_surface(w.smooth.reduced, w.sides);
  const auto weigh_all = [&] {
    w.evidences = evidences_of(w.fits, w.coarse, w.smooth, reduced, likelihood, w.evidences);
    w.probabilities = probabilities_of(w.fits, w.smooth.chi2, likelihood, w.evidences);
  };
  weigh_all();
  weigh_plausible(data, reduced, likelihood, options, &w);
  w.probabilities = probabilities_of(w.fits, w.smooth.chi2, likelihood, w.evidences);
  if (most_probable(w.probabilities) == CurveClass::Unclassified) {
    // Where nothing fits, a narrow valley may not have been walked to its end.
    refine_sharp_bends(data, reduced, &w);
    weigh_all();
  }
  const CurveClass candidate = best_class(w.fits, likelihood, w.evidences);
  const auto c = static_cast<std::size_t>(candidate);
  if (w.fits[c] && w.fits[c]->on_all) {
    w.canonical[c] = to_canonical(*w.fits[c], data);
  }
  if (w.fits[c] && w.canonical[c]) {
    const double dof = n - degrees_of_freedom(candidate);
    const double variance = w.fits[c]->chi2 / dof;  // of the residuals, in units of sigma^2
    const double noise = w.smooth.dof() > 0 ? w.smooth.chi2 / w.smooth.dof() : 1.0;
    const double excess = w.sigma * std::sqrt(std::max(0.0, variance - noise));
    // What the smooth model explains and the class does not, beyond what noise gives the smooth
    // model's further coefficients; a false alarm costs an answer its certainty.
    constexpr double kFalseAlarm = 1e-6;
    const int more = w.smooth.parameters - degrees_of_freedom(candidate);
    const bool misfits =
        most_probable(w.probabilities) == CurveClass::Unclassified ||
        (more > 0 && chi_square_survival((w.fits[c]->chi2 - w.smooth.chi2) / likelihood.inflation(),
                                         more) < kFalseAlarm);
    std::vector<double> residuals;
    for (const FittedPoint& point : w.canonical[c]->points) {
      residuals.push_back(point.residual);
    }
    const ResidualCorrelation correlation = correlation_of(data, residuals);
    // White residuals much larger than the smooth model's are noise that it took for bends
    // (outliers, samples out of order); correlated ones are form error up to its limit, neighbours
    // erring together, so that only one in `time` counts.
    constexpr double kMuchLarger = 1.5;
    constexpr double kLargestNoise = 0.01;      // of the half extent: beyond it nothing is measured
    constexpr double kLargestFormError = 1e-3;  // likewise: beyond it, it is another shape
    const bool noisy =
        correlation.time == 1.0 && variance > kMuchLarger * noise && excess <= kLargestNoise;
    const bool form_error = correlation.time > 1.0 && excess <= kLargestFormError;
    if (misfits && (noisy || form_error)) {
      likelihood.sigma_known = true;
      likelihood.samples = std::max(n / correlation.time, 1.0);
      likelihood.tempering = variance * correlation.time + stated;
      likelihood.coherent_variance = 0.0;
      likelihood.coherent_or_other = form_error;
      weigh_all();
      weigh_plausible(data, reduced, likelihood, options, &w);
      w.noise_inflation = variance * correlation.time;
      w.correlation_length = correlation.length;
    } else if (!sigma_known) {
      w.noise_inflation = counted(w.fits[c]->chi2, likelihood) / dof;
    }
  }
  w.inflation = w.noise_inflation + stated;
  choose_best(data, reduced, likelihood, &w);
  w.rival_share = rival_share(w.fits, likelihood, w.evidences);
  const auto& best = w.fits[static_cast<std::size_t>(w.best)];
  w.counted_chi2 = counted(best ? best->chi2 : w.smooth.chi2, likelihood);
  place_canonically(data, reduced, &w);
  if (const auto& placed = w.canonical[static_cast<std::size_t>(w.best)]) {
    const auto on_reduced = to_canonical(*w.coarse[static_cast<std::size_t>(w.best)], reduced);
    const auto valley = on_reduced
                            ? evidence_of(*on_reduced, reduced, w.inflation, Integration::Valley)
                            : std::nullopt;
    if (valley && valley->widest >= 0) {
      w.moment = with_bend(w.inflation * placed->covariance, w.inflation * on_reduced->covariance,
                           second_moment(*on_reduced, *valley, reduced));
    }
  }
  w.data = std::move(data);
  return w;
}

}  // namespace palpate
