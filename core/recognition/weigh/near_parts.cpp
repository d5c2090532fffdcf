#include "core/recognition/weigh/near_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/numerics/probability/log_add.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/coherent/near_class.h"
#include "core/recognition/weigh/near_best.h"

namespace palpate {
namespace {

/// log of the prior probability of parts near one class, over that of the class. Of touches that
/// lie apart nothing else in "unclassified" is smooth: all together they are half as probable as a
/// class, and no class is preferred.
const double kLogOfTouches = -std::log(2.0 * static_cast<double>(kCurveClasses.size()));

/// Standard deviations of the touches about the curve, in half extents, alike probable: a factor of
/// two apart, from where a class can hardly be seen to below kLargestNoise.
constexpr std::array kScatter = {0.25, 0.125, 0.0625, 0.03125, 0.015625, 0.0078125};

/// Where the noise is not stated, the posterior of a class has a density of 2 for each unit of log
/// sigma (Likelihood::log_evidence). So much of it lies between a noise that no probe reaches, a
/// millionth of the half extent, and kLargestNoise.
const double kLogOfNoises = std::log(2.0 * std::log(kLargestNoise / 1e-6));

/// The same points with `factor` times their noise. What normals are off by where a place is not
/// known follows (fit/orthogonal/measured_normal.h).
FitData with_noise(FitData data, double factor) {
  for (FitPoint& point : data.points) {
    point.inverse_sigma /= factor;
  }
  return data;
}

/// Sum of the logarithms of the deviations of what is measured.
double log_deviations(const CanonicalFit& placed, const FitData& data) {
  double sum = 0.0;
  for (std::size_t i = 0; i < placed.points.size(); ++i) {
    sum -= std::log(data.points[i].inverse_sigma);
    if (placed.points[i].normal_weight > 0.0) {
      sum -= std::log(placed.points[i].normal_weight);
    }
  }
  return sum;
}

/// log of the evidence of the parts near the curve of one class from which they deviate at each
/// touch for itself. `least`: less is not computed.
double log_evidence_scattered_near(const ClassFit& coarse, double least,
                                   const EvidenceContext& context) {
  const FitData& reduced = points_of(coarse, context.reduced);
  std::optional<double> at_noise;
  const double n = static_cast<double>(reduced.points.size());
  const double of_each = kLogOfTouches + (context.likelihood.sigma_known ? 0.0 : kLogOfNoises) -
                         std::log(static_cast<double>(kScatter.size()));
  const double inflation = context.likelihood.inflation();
  double sum = kNoEvidence;
  for (const double scatter : kScatter) {
    const double factor = std::hypot(1.0, scatter / (context.arcs.sigma * std::sqrt(inflation)));
    const double most =
        of_each - n * std::log(factor) - 0.5 * coarse.chi2 / (inflation * factor * factor);
    if (!(most > std::max(least, sum - kNegligibleLogOdds)) || !context.work.allows()) {
      continue;
    }
    if (!at_noise) {
      const auto at_curve = to_canonical(coarse, reduced);
      if (!at_curve) {
        return kNoEvidence;
      }
      at_noise = log_deviations(*at_curve, reduced);
    }
    const FitData scattered = with_noise(reduced, factor);
    const auto placed = to_canonical(coarse, scattered);
    const auto evidence =
        placed ? evidence_of(*placed, scattered, inflation, context.work) : std::nullopt;
    if (evidence) {
      sum = log_add(sum, of_each - (log_deviations(*placed, scattered) - *at_noise) -
                             0.5 * chi2_of(*placed) / inflation + evidence->log_occam);
    }
  }
  return sum;
}

/// The same of parts whose deviation from the class is smooth: the more touches there are, the
/// better they tell it from one that is another at each. nullopt where the noise is not stated
/// (what the class leaves would tell another one), and where nothing tells such deviations.
std::optional<double> log_evidence_smoothly_near(const ClassFit& coarse, double least,
                                                 const EvidenceContext& context) {
  const FitData& reduced = points_of(coarse, context.reduced);
  const auto placed = context.likelihood.sigma_known && context.work.allows()
                          ? to_canonical(coarse, reduced)
                          : std::nullopt;
  const double inflation = context.likelihood.inflation();
  const auto evidence =
      placed ? evidence_of(*placed, reduced, inflation, context.work) : std::nullopt;
  if (!evidence) {
    return std::nullopt;
  }
  const double of_class = kLogOfTouches - 0.5 * chi2_of(*placed) / inflation + evidence->log_occam;
  const auto gain =
      log_gain_near_class(*placed, *evidence, reduced, context.likelihood, context.arcs.sigma, 0.0,
                          0.0, least - of_class, context.work);
  return gain ? std::optional(of_class + *gain) : std::nullopt;
}

/// log of the evidence of touches' parts near any class. `least`: less is not computed. Deviations
/// that are smooth and others are alike probable, where both can be told.
double log_evidence_of_touches(const ClassFits& coarse, double least,
                               const EvidenceContext& context) {
  double sum = kNoEvidence;
  for (const auto& fit : coarse) {
    if (fit && !fit->at_limit && std::isfinite(fit->chi2)) {
      const double scattered = log_evidence_scattered_near(*fit, least, context);
      const auto smooth = log_evidence_smoothly_near(*fit, least, context);
      sum = log_add(sum, smooth ? log_add(scattered, *smooth) - std::log(2.0) : scattered);
    }
  }
  return sum;
}

}  // namespace

Contenders with_near_parts(Contenders contenders, const EvidenceContext& context, bool of_strokes,
                           double log_with_gross, double margin) {
  contenders.evidences.log_near = contenders.evidences.log_near_over_paths = kNoEvidence;
  const CurveClass best = best_class(contenders.fits, context.likelihood, contenders.evidences);
  if (!contenders.fits[best]) {
    return contenders;
  }
  const double of_class =
      log_evidence(context.likelihood, contenders.evidences, *contenders.fits[best]);
  // Less than a hundredth of what keeps the best from being RECOGNIZED is not asked for.
  const double least = of_class - margin - std::log(100.0);
  if (all_lie_apart(context.arcs.data)) {
    const double log_paths =
        log_evidence_of_paths(context.likelihood, contenders.evidences, context.arcs.smooth.chi2);
    const double log_near = log_add(log_evidence_of_touches(contenders.coarse, least, context),
                                    log_paths + log_with_gross);
    contenders.evidences.log_near = log_near;
    contenders.evidences.log_near_over_paths = log_near - log_paths;
  } else if (of_strokes) {
    contenders.evidences.log_near = log_evidence_near_best(best, 0.0, least, contenders, context);
  }
  return contenders;
}

}  // namespace palpate
