#include "core/recognition/posterior/posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/numerics/negligible.h"
#include "core/recognition/posterior/class_limits.h"
#include "core/recognition/posterior/prior_modes.h"
#include "core/recognition/posterior/slices.h"
#include "core/recognition/posterior/straight_paths.h"

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

/// What each class has in paths that are nearly straight. `before`: of the same line.
void add_straight_paths(const ClassFits& fits, const Likelihood& likelihood, const BendOfLine& bend,
                        const Evidences* before, Evidences* evidences, WorkBudget& work) {
  // One class's quadrature at most, beside an offset's cell: 235,000 instructions (callgrind).
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
    over_line = before != nullptr ? before->log_over_line[i] : kNoEvidence;
    if (!(over_line > kNoEvidence)) {
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

/// What evidences start from: free paths, and what `before` says of all classes.
Evidences started_from(const Evidences& before, const SmoothModel& smooth,
                       const Likelihood& likelihood, WorkBudget& work) {
  Evidences evidences;
  if (likelihood.inflation() == before.inflation) {
    evidences.inflation = before.inflation;
    evidences.free_form = before.free_form;
  } else {
    evidences = evidences_of_paths(smooth, likelihood, work);
  }
  evidences.log_shared = before.log_shared;
  evidences.shared_or_other = before.shared_or_other;
  return evidences;
}

/// Keeps the modes that the prior has led to for classes which have no evidence this time.
void keep_known(const Evidences& before, Evidences* found) {
  for (const CurveClass curve_class : kCurveClasses) {
    const ClassEvidence* known = known_of(before, curve_class);
    if (!found->classes[static_cast<std::size_t>(curve_class)] && known != nullptr &&
        known->prior_mode_sought) {
      found->known.push_back(*known);
    }
  }
}

/// Evidences by Laplace's formula, class by class.
class LaplaceEvidences {
 public:
  /// `paths`: those of free paths; `before`: what was found with the same noise, if anything.
  LaplaceEvidences(const ClassFits& fits, const ClassFits& on_reduced, const FitData& reduced,
                   double smooth_chi2, const Likelihood& likelihood, Evidences paths,
                   Evidences* before, WorkBudget& work)
      : found(std::move(paths)),
        best(log_evidence_of_unclassified(likelihood, found, smooth_chi2)),
        fits_(fits),
        on_reduced_(on_reduced),
        reduced_(reduced),
        likelihood_(likelihood),
        before_(before),
        work_(work) {}

  /// Adds a class that is fitted, unless it is there or chi-square alone tells that it is out.
  void take(CurveClass curve_class) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (found.classes[i] ||
        likelihood_.log_evidence(chi2(curve_class), 0.0, 0.0) + found.log_shared[i] <
            best - kNegligibleLogOdds) {
      return;
    }
    found.on_reduced_chi2[i] = on_reduced_[i]->chi2;
    if (is_same(curve_class)) {
      found.on_reduced[i] = std::move(before_->on_reduced[i]);
      found.classes[i] = std::move(before_->classes[i]);
    } else if ((found.on_reduced[i] = to_canonical(*on_reduced_[i], reduced_))) {
      found.classes[i] = evidence_of(*found.on_reduced[i], reduced_, found.inflation, work_);
      const ClassEvidence* earlier = known_of(*before_, curve_class);
      if (found.classes[i] && earlier != nullptr) {
        found.classes[i] = at_better_mode(*std::move(found.classes[i]), *earlier);
      }
    }
    best = std::max(best, log_evidence(likelihood_, found, curve_class, chi2(curve_class)));
  }

  /// Whether the class stood in the same fit before.
  bool is_same(CurveClass curve_class) const {
    // Of chi-square: a hundredth of a deviation, to which a fit that is settled again comes back.
    constexpr double kSameFit = 1e-4;
    const auto i = static_cast<std::size_t>(curve_class);
    return before_->classes[i] &&
           std::abs(before_->on_reduced_chi2[i] - on_reduced_[i]->chi2) <= kSameFit;
  }

  /// The bend that the points show of the line, where that has a share in the posterior.
  std::optional<BendOfLine> bend() const {
    constexpr auto kLine = static_cast<std::size_t>(CurveClass::Line);
    return is_seen(CurveClass::Line) && work_.allows()
               ? bend_of_line(*found.classes[kLine], chi2(CurveClass::Line), reduced_, likelihood_)
               : std::nullopt;
  }

  bool is_seen(CurveClass curve_class) const {
    return found.classes[static_cast<std::size_t>(curve_class)] &&
           log_evidence(likelihood_, found, curve_class, chi2(curve_class)) >
               best - kNegligibleLogOdds;
  }

  double chi2(CurveClass curve_class) const {
    return fits_[static_cast<std::size_t>(curve_class)]->chi2;
  }

  Evidences found;
  double best;  ///< log of the highest

 private:
  const ClassFits& fits_;
  const ClassFits& on_reduced_;
  const FitData& reduced_;
  const Likelihood& likelihood_;
  Evidences* before_;
  WorkBudget& work_;
};

}  // namespace

Evidences evidences_of(const ClassFits& fits, const ClassFits& on_reduced,
                       const SmoothModel& smooth, const FitData& reduced,
                       const Likelihood& likelihood, Evidences before, WorkBudget& work) {
  // A fit that leaves no less than nearly straight paths, both told to 1, is one of these.
  constexpr double kNoBetter = 2.0;
  const double inflation = likelihood.inflation();
  Evidences paths = started_from(before, smooth, likelihood, work);
  if (inflation != before.inflation) {
    before = {};
  }
  LaplaceEvidences laplace(fits, on_reduced, reduced, smooth.chi2, likelihood, std::move(paths),
                           &before, work);
  const std::vector<CurveClass> order = in_order_of_fit(fits);
  const bool line = std::find(order.begin(), order.end(), CurveClass::Line) != order.end();
  bool same_line = false;
  if (line) {
    same_line = laplace.is_same(CurveClass::Line);
    laplace.take(CurveClass::Line);
  }
  const auto bend = line ? laplace.bend() : std::nullopt;
  for (const CurveClass curve_class : order) {
    if (!bend || laplace.chi2(curve_class) <
                     laplace.chi2(CurveClass::Line) - inflation * (bend->fall() + kNoBetter)) {
      laplace.take(curve_class);
    }
  }
  if (bend && laplace.is_seen(CurveClass::Line)) {
    add_straight_paths(fits, likelihood, *bend, same_line ? &before : nullptr, &laplace.found,
                       work);
    keep_known(before, &laplace.found);
    return std::move(laplace.found);
  }
  for (const CurveClass curve_class : order) {
    laplace.take(curve_class);
  }
  add_prior_modes(fits, reduced, likelihood,
                  log_evidence_of_unclassified(likelihood, laplace.found, smooth.chi2),
                  &laplace.found, work);
  add_limits(fits, reduced, likelihood, laplace.best, before, &laplace.found, work);
  keep_known(before, &laplace.found);
  return std::move(laplace.found);
}

Evidences integrated(Evidences evidences, const ClassFits& fits, const ClassFits& on_reduced,
                     double smooth_chi2, const FitData& reduced, const Likelihood& likelihood,
                     double margin, WorkBudget& work) {
  // Slices seldom change a mass by ten: with ten times that, what cannot keep the best from being
  // RECOGNIZED stays out.
  const double matters_within = margin + std::log(100.0);
  std::array<double, 9> log_of = kNoEvidences;
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
    return log_evidence > kNoEvidence && log_evidence >= *best - matters_within;
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
    evidences.on_reduced_chi2[i] = kNoEvidence;  // no longer Laplace's: not to be taken over
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
  std::array<double, 9> log_of = kNoEvidences;
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
  for (const auto& [beyond, inside] : kConics) {
    const auto b = static_cast<std::size_t>(beyond);
    const auto i = static_cast<std::size_t>(inside);
    if (fits[b] && fits[b]->at_limit && !std::isfinite(log_of[b]) && evidences.classes[i] &&
        fits[i] && std::isfinite(log_of[i])) {
      // To first order chi-square goes on beyond the parabola as it came: a normal law's tail.
      const double rise = likelihood.counted(fits[b]->chi2) - likelihood.counted(fits[i]->chi2);
      const double tail = 0.5 * std::erfc(std::sqrt(0.5 * std::max(rise, 0.0)));
      log_of[b] = log_of[i] - std::log1p(-tail) + std::log(std::max(tail, 1e-300)) +
                  log_density_ratio_beyond(beyond, *evidences.classes[i]);
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
