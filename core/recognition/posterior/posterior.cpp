#include "core/recognition/posterior/posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/modes/slices.h"
#include "core/recognition/posterior/class_limits.h"

namespace palpate {
namespace {

/// The spline's other mode, if there is one.
std::optional<ClassEvidence> rival_of(const ClassFit& spline, const FitData& reduced,
                                      double inflation, WorkBudget& work) {
  if (!spline.rival || is_same_curve(*spline.polynomial, *spline.rival)) {
    return std::nullopt;
  }
  ClassFit fit;
  fit.curve_class = spline.curve_class;
  fit.chi2 = spline.rival->chi2;
  fit.polynomial = spline.rival;
  const auto canonical = to_canonical(fit, reduced);
  return canonical ? evidence_of(*canonical, reduced, inflation, work) : std::nullopt;
}

/// The share of a spline's slices about another mode of it; nullopt if they do not run through it.
std::optional<double> share_in_slices(const ClassEvidence& spline, const ClassEvidence& other,
                                      const FitData& reduced, WorkBudget& work) {
  constexpr int kBend = 3;  // the coordinate c
  if (spline.widest != kBend || spline.touch.as_arc) {
    return std::nullopt;
  }
  return share_of_other_mode(spline, coordinates_of(spline.touch.chart(), other.touch.shape),
                             reduced, work);
}

/// The share of the spline's posterior in a mode that its slices do not run through.
double share_of_separate_rival(const ClassFits& fits, const Likelihood& likelihood,
                               const Evidences& evidences) {
  const auto& spline = fits[CurveClass::CubicSpline];
  const auto& own = evidences.classes[CurveClass::CubicSpline];
  if (!spline || !own || !evidences.rival || !spline->rival || !std::isfinite(spline->chi2)) {
    return 0.0;
  }
  const double rise = (spline->rival->chi2 - spline->polynomial->chi2) / likelihood.inflation();
  const double log_ratio = evidences.rival->log_occam - own->log_occam - 0.5 * rise;
  // The rival fits worse; where its evidence says much more all the same, the two are one mode.
  return 1.0 / (1.0 + std::exp(-std::min(log_ratio, kNegligibleLogOdds)));
}

/// Each side of the parabola, and the other.
constexpr std::array kConics = {std::pair(CurveClass::Ellipse, CurveClass::Hyperbola),
                                std::pair(CurveClass::Hyperbola, CurveClass::Ellipse)};

}  // namespace

Evidences integrated(Evidences evidences, const ClassFits& fits, const ClassFits& on_reduced,
                     double smooth_chi2, const FitData& reduced, const Likelihood& likelihood,
                     double margin, WorkBudget& work) {
  // Slices seldom change a mass by ten: with ten times that, what cannot keep the best from being
  // RECOGNIZED stays out.
  const double matters_within = margin + std::log(100.0);
  ByClass<double> log_of = kNoEvidences;
  log_of[0] = log_evidence_of_unclassified(likelihood, evidences, smooth_chi2);
  for (const CurveClass curve_class : kCurveClasses) {
    if (fits[curve_class] && is_wanted(evidences, curve_class)) {
      log_of[curve_class] = log_evidence(likelihood, evidences, *fits[curve_class]);
    }
  }
  constexpr auto kSpline = CurveClass::CubicSpline;
  const auto best = std::max_element(log_of.begin(), log_of.end());
  // Where nothing has evidence, as where noise is so small that rounding hides it, nothing matters.
  const auto matters = [&](double log_evidence) {
    return log_evidence > kNoEvidence && log_evidence >= *best - matters_within;
  };
  const bool spline_is_best = best == &log_of[kSpline] && on_reduced[kSpline]->rival;
  if ((std::count_if(log_of.begin(), log_of.end(), matters) < 2 && !spline_is_best) ||
      !work.allows()) {
    return evidences;  // however wide, one class has all of the mass
  }
  for (const CurveClass curve_class : kCurveClasses) {
    if (!matters(log_of[curve_class]) || !evidences.classes[curve_class] ||
        has_straight_paths(evidences, curve_class)) {
      continue;
    }
    auto evidence =
        by_slices(*evidences.classes[curve_class], points_of(*on_reduced[curve_class], reduced),
                  evidences.inflation, Slices::ForMass, work);
    if (!evidence) {
      continue;
    }
    evidences.classes[curve_class] = std::move(evidence);
    evidences.on_reduced_chi2[curve_class].reset();  // no longer Laplace's: not to be copied
  }
  if (matters(log_of[kSpline]) && evidences.classes[kSpline] &&
      !has_straight_paths(evidences, CurveClass::CubicSpline)) {
    const FitData& points = points_of(*on_reduced[kSpline], reduced);
    evidences.rival = rival_of(*on_reduced[kSpline], points, evidences.inflation, work);
    const auto held = evidences.rival ? share_in_slices(*evidences.classes[kSpline],
                                                        *evidences.rival, points, work)
                                      : std::nullopt;
    if (held) {
      evidences.rival_in_slices = *held;
      evidences.rival.reset();
    } else if (evidences.rival) {
      // Laplace's formula would have all widths of the prior where the square of c alone is told.
      auto sliced = by_slices(*evidences.rival, points, evidences.inflation, Slices::ForMass, work);
      if (sliced) {
        evidences.rival = std::move(sliced);
      }
    }
  }
  return evidences;
}

ClassProbabilities probabilities_of(const ClassFits& fits, double smooth_chi2,
                                    const Likelihood& likelihood, const Evidences& evidences) {
  ByClass<double> log_of = kNoEvidences;
  log_of[0] = log_evidence_of_unclassified(likelihood, evidences, smooth_chi2);
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& evidence = evidences.classes[curve_class];
    if (fits[curve_class] && is_wanted(evidences, curve_class) &&
        (has_straight_paths(evidences, curve_class) ||
         (evidence && fits[curve_class]->at_limit == evidence->counted_from_limit))) {
      log_of[curve_class] = log_evidence(likelihood, evidences, *fits[curve_class]);
    }
  }
  // Both modes of the spline.
  const double share = share_of_separate_rival(fits, likelihood, evidences);
  log_of[CurveClass::CubicSpline] -= std::log1p(-share);
  for (const auto& [beyond, inside] : kConics) {
    if (fits[beyond] && fits[beyond]->at_limit && !std::isfinite(log_of[beyond]) &&
        evidences.classes[inside] && fits[inside] && std::isfinite(log_of[inside])) {
      // To first order chi-square goes on beyond the parabola as it came: a normal law's tail.
      const double rise =
          likelihood.counted(fits[beyond]->chi2) - likelihood.counted(fits[inside]->chi2);
      const double tail = 0.5 * std::erfc(std::sqrt(0.5 * std::max(rise, 0.0)));
      log_of[beyond] = log_of[inside] - std::log1p(-tail) + std::log(std::max(tail, 1e-300)) +
                       log_density_ratio_beyond(beyond, *evidences.classes[inside]);
    }
  }
  if (likelihood.coherent_or_other || evidences.shared_or_other) {
    // What the class leaves is a deviation of part or probe, or another shape: even odds.
    log_of[0] = std::nextafter(*std::max_element(log_of.begin() + 1, log_of.end()), kNoEvidence);
  }
  const double best = *std::max_element(log_of.begin(), log_of.end());
  ClassProbabilities result{};
  if (!(best > kNoEvidence)) {
    result[0] = 1.0;  // no class is told
    return result;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < log_of.size(); ++i) {
    result[i] = std::exp(log_of[i] - best);
    sum += result[i];
  }
  for (double& p : result) {
    p /= sum;
  }
  return result;
}

double margin_of_unclassified(const ClassFits& fits, double smooth_chi2,
                              const Likelihood& likelihood, const Evidences& evidences) {
  double highest = kNoEvidence;
  for (const CurveClass curve_class : kCurveClasses) {
    const auto& fit = fits[curve_class];
    const auto& evidence = evidences.classes[curve_class];
    if (!fit || fit->at_limit || !std::isfinite(fit->chi2) || !is_wanted(evidences, curve_class)) {
      continue;
    }
    if (evidence) {
      highest = std::max(highest, likelihood.log_evidence(fit->chi2, evidence->log_occam_of_touch,
                                                          evidence->determined));
    } else if (!has_straight_paths(evidences, curve_class)) {
      // Hopeless by chi-square alone, or no optimum of the prior's: then this bounds what it has.
      highest = std::max(highest, likelihood.log_evidence(fit->chi2, 0.0, 0.0));
    }
  }
  return log_evidence_of_unclassified(likelihood, evidences, smooth_chi2) - highest;
}

double rival_share(const ClassFits& fits, const Likelihood& likelihood,
                   const Evidences& evidences) {
  return evidences.rival ? share_of_separate_rival(fits, likelihood, evidences)
                         : evidences.rival_in_slices;
}

}  // namespace palpate
