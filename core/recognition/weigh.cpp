#include "core/recognition/weigh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/recognition/residual_correlation.h"
#include "core/recognition/tip_sides.h"

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

/// The class of the lowest criterion: probabilities beside "unclassified" may all have vanished.
CurveClass best_class(const ClassFits& fits, const EvidenceScale& scale) {
  CurveClass best = CurveClass::Unclassified;
  double lowest = std::numeric_limits<double>::infinity();
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& fit = fits[static_cast<std::size_t>(curve_class)];
    if (fit && !fit->at_limit) {
      const double criterion =
          information_criterion(fit->chi2, degrees_of_freedom(curve_class), scale);
      if (criterion < lowest) {
        lowest = criterion;
        best = curve_class;
      }
    }
  }
  return best;
}

double criterion_of(const ClassFit& fit, const EvidenceScale& scale) {
  return information_criterion(fit.chi2, degrees_of_freedom(fit.curve_class), scale);
}

/// Fits to the reduced points for the way the material lies beside the patches: where the probes do
/// not say it, the way under which all points are fitted best, the first (from outside the bends)
/// at the odds of the prior. Sets w->sides and w->sides_margin.
ClassFits fit_over_sides(std::span<const StoredPatch> patches, const FitData& data,
                         const EvidenceScale& scale, const RecognizerOptions& options,
                         const WarmStart* warm, Weighing* w) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const SmoothModel& smooth = w->smooth;
  const auto ways = possible_sides(patches, smooth.reduced);
  if (ways.size() == 1) {
    w->sides_margin = kInfinity;
    w->sides = ways.front();
    const FitData reduced = on_surface(smooth.reduced, w->sides);
    const auto starts = warm != nullptr ? std::optional(carried_to(*warm, reduced)) : std::nullopt;
    return fit_classes(reduced, starts ? &*starts : nullptr, options.classes);
  }
  const double inside = options.inside_probability;
  const double price_of_inside = 2.0 * std::log((1.0 - inside) / inside);
  ClassFits best;
  double lowest = kInfinity;
  double second = kInfinity;
  for (const std::vector<int>& sides : ways) {
    const FitData reduced = on_surface(smooth.reduced, sides);
    ClassFits fits = fit_classes(reduced, nullptr, options.classes);
    const CurveClass candidate = best_class(fits, scale);
    const auto& fit = fits[static_cast<std::size_t>(candidate)];
    const auto refined = fit ? refine_on_all(*fit, reduced, smooth, data) : std::nullopt;
    const bool first = &sides == &ways.front();
    // A line has no bend to be outside of.
    const double price = first || candidate == CurveClass::Line ? 0.0 : price_of_inside;
    const double criterion = refined ? criterion_of(*refined, scale) + price : kInfinity;
    if (first || criterion < lowest) {
      second = lowest;
      lowest = criterion;
      best = std::move(fits);
      w->sides = sides;
    } else {
      second = std::min(second, criterion);
    }
  }
  w->sides_margin = std::isfinite(second) ? second - lowest : kInfinity;
  return best;
}

/// Refines on all points what is plausible and not yet refined there. The others keep the
/// chi-square that the reduced points tell.
void refine_plausible(const FitData& data, const FitData& reduced, const SmoothModel& smooth,
                      const EvidenceScale& scale, ClassFits* fits) {
  // No reduction error brings a hopeless class back. Where the smooth model itself misfits, neither
  // it nor the reduced points can be trusted that far.
  const double hopeless = kHopeless * std::max(1.0, smooth.noise_ratio() * smooth.noise_ratio());
  for (bool changed = true; changed;) {
    changed = false;
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& fit : *fits) {
      lowest = fit ? std::min(lowest, criterion_of(*fit, scale)) : lowest;
    }
    for (auto& fit : *fits) {
      if (!fit || fit->on_all || fit->at_limit || !std::isfinite(fit->chi2) ||
          !(criterion_of(*fit, scale) < lowest + hopeless)) {
        continue;
      }
      changed = true;
      if (auto refined = refine_on_all(*fit, reduced, smooth, data)) {
        fit = std::move(refined);
      } else {
        fit->chi2 = std::numeric_limits<double>::infinity();
      }
    }
  }
  // Ellipse and hyperbola at their limit are the parabola.
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

/// Spares no effort on the models with sharp bends.
void refine_sharp_bends(const ClassFits& coarse, const FitData& data, const FitData& reduced,
                        const SmoothModel& smooth, ClassFits* fits) {
  for (const CurveClass curve_class : {CurveClass::SemiCubicalParabola, CurveClass::CubicSpline}) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (!coarse[i]) {
      continue;
    }
    auto refined = refine_on_all(*coarse[i], reduced, smooth, data, RefineEffort{});
    if (refined && refined->chi2 < (*fits)[i]->chi2) {
      (*fits)[i] = std::move(refined);
    }
  }
}

CurveClass most_probable(const ClassProbabilities& probabilities) {
  return static_cast<CurveClass>(std::max_element(probabilities.begin(), probabilities.end()) -
                                 probabilities.begin());
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
  EvidenceScale scale;
  scale.sigma_known = sigma_known;
  scale.samples = n;
  scale.parsimony = options.parsimony;
  // Residuals below the rounding of the coordinates say nothing.
  w.sigma = rms_sigma(data);
  const double rounding = rounding_level(data) / w.sigma;
  scale.chi2_floor = sigma_known ? 0.0 : n * rounding * rounding;

  w.coarse = fit_over_sides(patches, data, scale, options, warm, &w);
  w.fits = w.coarse;
  for (const CurveClass curve_class : kCurveClasses) {
    // A class must leave something over to test it with.
    const auto i = static_cast<std::size_t>(curve_class);
    const bool wanted = (options.classes & (1U << i)) != 0;
    if (!wanted || static_cast<int>(data.points.size()) <= degrees_of_freedom(curve_class)) {
      w.fits[i].reset();
      w.coarse[i].reset();
    }
  }
  for (auto& fit : w.fits) {
    if (fit) {
      fit->chi2 += w.smooth.chi2;  // as the reduced points tell it
    }
  }
  const FitData reduced = on_surface(w.smooth.reduced, w.sides);
  refine_plausible(data, reduced, w.smooth, scale, &w.fits);
  w.probabilities = probabilities(w.fits, w.smooth.chi2, w.smooth.parameters, scale);
  if (most_probable(w.probabilities) == CurveClass::Unclassified) {
    // Where nothing fits, a narrow valley may not have been walked to its end.
    refine_sharp_bends(w.coarse, data, reduced, w.smooth, &w.fits);
    w.probabilities = probabilities(w.fits, w.smooth.chi2, w.smooth.parameters, scale);
  }
  const CurveClass candidate = best_class(w.fits, scale);
  const auto c = static_cast<std::size_t>(candidate);
  if (w.fits[c] && w.fits[c]->on_all) {
    if (auto polished = polish(*w.fits[c], data)) {
      w.fits[c] = std::move(polished);
    }
  }
  if (w.fits[c] && w.fits[c]->on_all) {
    w.canonical[c] = to_canonical(*w.fits[c], data);
  }
  if (w.fits[c] && w.canonical[c]) {
    const double dof = n - degrees_of_freedom(candidate);
    const double variance = w.fits[c]->chi2 / dof;  // of the residuals, in units of sigma^2
    const double noise = w.smooth.dof() > 0 ? w.smooth.chi2 / w.smooth.dof() : 1.0;
    const double excess = w.sigma * std::sqrt(std::max(0.0, variance - noise));
    const bool misfits = most_probable(w.probabilities) == CurveClass::Unclassified;
    std::vector<double> residuals;
    for (const FittedPoint& point : w.canonical[c]->points) {
      residuals.push_back(point.residual);
    }
    const ResidualCorrelation correlation = correlation_of(data, residuals);
    // White residuals much larger than the smooth model's are noise that it took for bends
    // (outliers, samples out of order); correlated ones are form error up to its limit, neighbours
    // erring together, so that only one in `time` counts.
    constexpr double kMuchLarger = 1.5;
    constexpr double kLargestNoise = 0.01;  // of the half extent: beyond it nothing is measured
    const bool noisy =
        correlation.time == 1.0 && variance > kMuchLarger * noise && excess <= kLargestNoise;
    const bool form_error = correlation.time > 1.0 && excess <= options.form_error_fraction;
    if (misfits && (noisy || form_error)) {
      EvidenceScale tempered = scale;
      tempered.sigma_known = true;
      tempered.samples = std::max(n / correlation.time, 1.0);
      tempered.tempering = variance * correlation.time;
      refine_plausible(data, reduced, w.smooth, tempered, &w.fits);
      w.probabilities = probabilities(w.fits, w.smooth.chi2, w.smooth.parameters, tempered);
      w.inflation = variance * correlation.time;
      w.correlation_length = correlation.length;
    } else if (!sigma_known) {
      w.inflation = variance;
    }
  }
  w.best = most_probable(w.probabilities);
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    constexpr double kNegligible = 1e-6;
    if (w.fits[i] && w.fits[i]->on_all && !w.canonical[i] && w.probabilities[i] > kNegligible) {
      w.canonical[i] = to_canonical(*w.fits[i], data);
    }
  }
  w.data = std::move(data);
  return w;
}

}  // namespace palpate
