#include "core/recognition/posterior/posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/numerics/log_add.h"
#include "core/numerics/negligible.h"
#include "core/recognition/posterior/class_limits.h"
#include "core/recognition/posterior/prior_modes.h"
#include "core/recognition/posterior/slices.h"
#include "core/recognition/posterior/straight_paths.h"

namespace palpate {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

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
  const auto& spline = fits[static_cast<std::size_t>(CurveClass::CubicSpline)];
  const auto& own = evidences.classes[static_cast<std::size_t>(CurveClass::CubicSpline)];
  if (!spline || !own || !evidences.rival || !spline->rival || !std::isfinite(spline->chi2)) {
    return 0.0;
  }
  const double rise = (spline->rival->chi2 - spline->polynomial->chi2) / likelihood.inflation();
  const double log_ratio = evidences.rival->log_occam - own->log_occam - 0.5 * rise;
  // The rival fits worse; where its evidence says much more all the same, the two are one mode.
  return 1.0 / (1.0 + std::exp(-std::min(log_ratio, kNegligibleLogOdds)));
}

}  // namespace

Evidences evidences_of_paths(const SmoothModel& smooth, const Likelihood& likelihood,
                             WorkBudget& work) {
  Evidences evidences;
  evidences.inflation = likelihood.inflation();
  evidences.free_form = free_form(smooth, evidences.inflation, work);
  return evidences;
}

double log_evidence_of_unclassified(const Likelihood& likelihood, const Evidences& evidences,
                                    double smooth_chi2) {
  const FreeForm& paths = evidences.free_form;
  const double log_paths = likelihood.log_evidence(
      smooth_chi2 + likelihood.inflation() * paths.chi2, paths.log_occam, paths.determined);
  return std::isfinite(evidences.log_near) ? log_add(log_paths, evidences.log_near) - std::log(2.0)
                                           : log_paths;
}

double log_evidence(const Likelihood& likelihood, const Evidences& evidences,
                    CurveClass curve_class, double chi2) {
  const auto i = static_cast<std::size_t>(curve_class);
  const auto& evidence = evidences.classes[i];
  const double about_fit =
      evidence && std::isfinite(chi2)
          ? likelihood.log_evidence(chi2, evidence->log_occam, evidence->determined)
          : kNone;
  return std::max(about_fit, evidences.log_straight[i]) + evidences.log_shared[i];
}

namespace {

/// Whether the line has a share in the posterior.
bool is_line_in_question(const ClassFits& fits, const Likelihood& likelihood,
                         const Evidences& evidences, double best) {
  constexpr auto kLine = static_cast<std::size_t>(CurveClass::Line);
  return fits[kLine] && evidences.classes[kLine] &&
         log_evidence(likelihood, evidences, CurveClass::Line, fits[kLine]->chi2) >
             best - kNegligibleLogOdds;
}

/// What each class has in paths that are nearly straight. `before`: of the same line.
void add_straight_paths(const ClassFits& fits, const Likelihood& likelihood, const BendOfLine& bend,
                        const Evidences* before, Evidences* evidences, WorkBudget& work) {
  // One class's quadrature, beside an offset's cell: 235,000 instructions (callgrind).
  constexpr std::size_t kCellsOfClass = 46;
  constexpr auto kLine = static_cast<std::size_t>(CurveClass::Line);
  const auto& line = *evidences->classes[kLine];
  const double of_line =
      likelihood.log_evidence(fits[kLine]->chi2, line.log_occam, line.determined);
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (i == kLine || !fits[i]) {
      continue;
    }
    double& over_line = evidences->log_over_line[i];
    over_line = before != nullptr ? before->log_over_line[i] : kNone;
    if (!(over_line > kNone)) {
      work.spend(WorkKind::OffsetCell, kCellsOfClass);
      over_line = log_evidence_over_line(curve_class, bend);
    }
    evidences->log_straight[i] = of_line + over_line;
  }
}

/// The classes that have a fit, the best first: what the prior leaves is at most all, so that the
/// rest can be told by chi-square alone.
std::vector<CurveClass> in_order_of_fit(const ClassFits& fits) {
  std::vector<CurveClass> order(kCurveClasses.begin(), kCurveClasses.end());
  std::erase_if(order, [&](CurveClass c) {
    const auto& fit = fits[static_cast<std::size_t>(c)];
    return !fit || fit->at_limit || !std::isfinite(fit->chi2);
  });
  std::sort(order.begin(), order.end(), [&](CurveClass a, CurveClass b) {
    return fits[static_cast<std::size_t>(a)]->chi2 < fits[static_cast<std::size_t>(b)]->chi2;
  });
  return order;
}

}  // namespace

Evidences evidences_of(const ClassFits& fits, const ClassFits& on_reduced,
                       const SmoothModel& smooth, const FitData& reduced,
                       const Likelihood& likelihood, Evidences before, WorkBudget& work) {
  const double inflation = likelihood.inflation();
  // Of chi-square: a hundredth of a deviation, to which a fit that is settled again comes back.
  constexpr double kSameFit = 1e-4;
  constexpr auto kLine = static_cast<std::size_t>(CurveClass::Line);
  const bool same_noise = inflation == before.inflation;
  Evidences evidences;
  if (same_noise) {
    evidences.inflation = inflation;
    evidences.free_form = before.free_form;
  } else {
    evidences = evidences_of_paths(smooth, likelihood, work);
  }
  evidences.log_shared = before.log_shared;
  evidences.shared_or_other = before.shared_or_other;
  double best = log_evidence_of_unclassified(likelihood, evidences, smooth.chi2);
  const auto is_same = [&](std::size_t i) {
    return same_noise && before.classes[i] &&
           std::abs(before.on_reduced_chi2[i] - on_reduced[i]->chi2) <= kSameFit;
  };
  const auto take = [&](CurveClass curve_class) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (evidences.classes[i] ||
        likelihood.log_evidence(fits[i]->chi2, 0.0, 0.0) + evidences.log_shared[i] <
            best - kNegligibleLogOdds) {
      return;
    }
    evidences.on_reduced_chi2[i] = on_reduced[i]->chi2;
    if (is_same(i)) {
      evidences.on_reduced[i] = before.on_reduced[i];
      evidences.classes[i] = before.classes[i];
    } else if ((evidences.on_reduced[i] = to_canonical(*on_reduced[i], reduced))) {
      evidences.classes[i] = evidence_of(*evidences.on_reduced[i], reduced, inflation, work);
      if (same_noise && evidences.classes[i] && before.classes[i]) {
        evidences.classes[i] = at_better_mode(*std::move(evidences.classes[i]), *before.classes[i]);
      }
    }
    best = std::max(best, log_evidence(likelihood, evidences, curve_class, fits[i]->chi2));
  };
  const std::vector<CurveClass> order = in_order_of_fit(fits);
  std::optional<BendOfLine> bend;
  if (std::find(order.begin(), order.end(), CurveClass::Line) != order.end()) {
    take(CurveClass::Line);
    if (is_line_in_question(fits, likelihood, evidences, best) && work.allows()) {
      bend = bend_of_line(*evidences.classes[kLine], fits[kLine]->chi2, reduced, likelihood);
    }
  }
  // A fit that leaves no less than nearly straight paths, both told to 1, is one of these.
  constexpr double kNoBetter = 2.0;
  const double of_straight =
      bend ? fits[kLine]->chi2 - inflation * (bend->fall() + kNoBetter) : 0.0;
  for (const CurveClass curve_class : order) {
    if (!bend || fits[static_cast<std::size_t>(curve_class)]->chi2 < of_straight) {
      take(curve_class);
    }
  }
  if (bend && is_line_in_question(fits, likelihood, evidences, best)) {
    add_straight_paths(fits, likelihood, *bend, is_same(kLine) ? &before : nullptr, &evidences,
                       work);
    return evidences;
  }
  for (const CurveClass curve_class : order) {
    take(curve_class);
  }
  add_prior_modes(fits, reduced, likelihood,
                  log_evidence_of_unclassified(likelihood, evidences, smooth.chi2), &evidences,
                  work);
  add_limits(fits, reduced, likelihood, best, same_noise ? before : Evidences{}, &evidences, work);
  return evidences;
}

Evidences integrated(Evidences evidences, const ClassFits& fits, const ClassFits& on_reduced,
                     double smooth_chi2, const FitData& reduced, const Likelihood& likelihood,
                     double margin, WorkBudget& work) {
  // Slices seldom change a mass by ten: with ten times that, what cannot keep the best from being
  // RECOGNIZED stays out.
  const double matters_within = margin + std::log(100.0);
  std::array<double, 9> log_of;
  log_of.fill(kNone);
  log_of[0] = log_evidence_of_unclassified(likelihood, evidences, smooth_chi2);
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (fits[i]) {
      log_of[i] = log_evidence(likelihood, evidences, curve_class, fits[i]->chi2);
    }
  }
  constexpr auto kSpline = static_cast<std::size_t>(CurveClass::CubicSpline);
  const auto best = std::max_element(log_of.begin(), log_of.end());
  // Where nothing has evidence, as where noise is so small that rounding hides it, nothing matters.
  const auto matters = [&](double log_evidence) {
    return log_evidence > kNone && log_evidence >= *best - matters_within;
  };
  const bool spline_is_best = best == log_of.begin() + kSpline && on_reduced[kSpline]->rival;
  if ((std::count_if(log_of.begin(), log_of.end(), matters) < 2 && !spline_is_best) ||
      !work.allows()) {
    return evidences;  // however wide, one class has all of the mass
  }
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (!matters(log_of[i]) || !evidences.classes[i] ||
        has_straight_paths(evidences, curve_class)) {
      continue;
    }
    auto evidence =
        by_slices(*evidences.classes[i], reduced, evidences.inflation, Slices::ForMass, work);
    if (!evidence) {
      continue;
    }
    evidences.classes[i] = std::move(evidence);
    evidences.on_reduced_chi2[i] = kNone;  // no longer Laplace's: not to be taken over
  }
  if (matters(log_of[kSpline]) && evidences.classes[kSpline] &&
      !has_straight_paths(evidences, CurveClass::CubicSpline)) {
    // Of a class that is only one of several, Laplace's formula tells the other mode's share well
    // enough.
    evidences.rival = rival_of(*on_reduced[kSpline], reduced, evidences.inflation, work);
    const auto held = evidences.rival ? share_in_slices(*evidences.classes[kSpline],
                                                        *evidences.rival, reduced, work)
                                      : std::nullopt;
    if (held) {
      evidences.rival_in_slices = *held;
      evidences.rival.reset();
    } else if (evidences.rival && spline_is_best) {
      evidences.rival = by_slices(*std::move(evidences.rival), reduced, evidences.inflation,
                                  Slices::ForMass, work);
    }
  }
  return evidences;
}

namespace {

/// Each side of the parabola, and the other.
constexpr std::array kConics = {std::pair(CurveClass::Ellipse, CurveClass::Hyperbola),
                                std::pair(CurveClass::Hyperbola, CurveClass::Ellipse)};

}  // namespace

ClassProbabilities probabilities_of(const ClassFits& fits, double smooth_chi2,
                                    const Likelihood& likelihood, const Evidences& evidences) {
  std::array<double, 9> log_of;
  log_of.fill(kNone);
  log_of[0] = log_evidence_of_unclassified(likelihood, evidences, smooth_chi2);
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    const auto& evidence = evidences.classes[i];
    if (fits[i] && (has_straight_paths(evidences, curve_class) ||
                    (evidence && fits[i]->at_limit == evidence->at_limit))) {
      log_of[i] = log_evidence(likelihood, evidences, curve_class, fits[i]->chi2);
    }
  }
  // Both modes of the spline.
  const double share = share_of_separate_rival(fits, likelihood, evidences);
  log_of[static_cast<std::size_t>(CurveClass::CubicSpline)] -= std::log1p(-share);
  const auto& parabola = evidences.classes[static_cast<std::size_t>(CurveClass::Parabola)];
  for (const auto& [beyond, inside] : kConics) {
    const auto b = static_cast<std::size_t>(beyond);
    const auto i = static_cast<std::size_t>(inside);
    if (fits[b] && fits[b]->at_limit && !std::isfinite(log_of[b]) && parabola && fits[i] &&
        std::isfinite(log_of[i])) {
      // To first order chi-square goes on beyond the parabola as it came: a normal law's tail.
      const double rise = likelihood.counted(fits[b]->chi2) - likelihood.counted(fits[i]->chi2);
      const double tail = 0.5 * std::erfc(std::sqrt(0.5 * std::max(rise, 0.0)));
      log_of[b] = log_of[i] - std::log1p(-tail) + std::log(std::max(tail, 1e-300)) +
                  log_density_ratio_at_parabola(beyond, *parabola);
    }
  }
  if (likelihood.coherent_or_other || evidences.shared_or_other) {
    // What the class leaves is a deviation of part or probe, or another shape: even odds.
    log_of[0] = std::nextafter(*std::max_element(log_of.begin() + 1, log_of.end()), kNone);
  }
  const double best = *std::max_element(log_of.begin(), log_of.end());
  ClassProbabilities result{};
  if (!(best > kNone)) {
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
  double highest = kNone;
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    const auto& evidence = evidences.classes[i];
    if (evidence && fits[i] && std::isfinite(fits[i]->chi2)) {
      highest =
          std::max(highest, likelihood.log_evidence(fits[i]->chi2, evidence->log_occam_of_touch,
                                                    evidence->determined));
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
