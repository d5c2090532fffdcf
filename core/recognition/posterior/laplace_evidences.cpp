#include "core/recognition/posterior/laplace_evidences.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/class_limits.h"
#include "core/recognition/posterior/prior_modes.h"
#include "core/recognition/posterior/straight_paths.h"

namespace palpate {
namespace {

/// What each class has in paths that are nearly straight. `before`: of the same line.
void add_straight_paths(const ClassFits& fits, const Likelihood& likelihood, const BendOfLine& bend,
                        const Evidences* before, Evidences* evidences, WorkBudget& work) {
  // One class's quadrature at most, beside an offset's cell: 235,000 instructions (callgrind).
  constexpr std::size_t kCellsOfClass = 46;
  constexpr auto kLine = CurveClass::Line;
  const auto& line = *evidences->classes[kLine];
  const double of_line =
      likelihood.log_evidence(fits[kLine]->chi2, line.log_occam, line.determined);
  for (const CurveClass curve_class : kCurveClasses) {
    if (curve_class == kLine || !fits[curve_class]) {
      continue;
    }
    double& over_line = evidences->log_over_line[curve_class];
    over_line = before != nullptr ? before->log_over_line[curve_class] : kNoEvidence;
    if (!(over_line > kNoEvidence)) {
      work.spend(WorkKind::OffsetCell, kCellsOfClass);
      over_line = log_evidence_over_line(curve_class, bend);
    }
    evidences->log_straight[curve_class] = of_line + over_line;
  }
}

/// The classes that have a fit, the best first: what the prior leaves is at most all, so that the
/// rest can be told by chi-square alone.
std::vector<CurveClass> in_order_of_fit(const ClassFits& fits) {
  std::vector<CurveClass> order(kCurveClasses.begin(), kCurveClasses.end());
  std::erase_if(order, [&](CurveClass c) {
    const auto& fit = fits[c];
    return !fit || fit->at_limit || !std::isfinite(fit->chi2);
  });
  std::sort(order.begin(), order.end(),
            [&](CurveClass a, CurveClass b) { return fits[a]->chi2 < fits[b]->chi2; });
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
    evidences = evidences_of_paths(smooth, likelihood, nullptr, work);
  }
  evidences.limits_only = before.limits_only;
  evidences.log_shared = before.log_shared;
  evidences.shared_or_other = before.shared_or_other;
  return evidences;
}

/// Keeps the modes that the prior has led to for classes which have no evidence this time. (Those
/// that have were moved out of `before`.)
void keep_known(const Evidences& before, Evidences* found) {
  for (const CurveClass curve_class : kCurveClasses) {
    const ClassEvidence* known = known_of(before, curve_class);
    if (!found->classes[curve_class] && known != nullptr && known->prior_mode_sought) {
      found->earlier_modes.push_back(*known);
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
    if (found.classes[curve_class] ||
        likelihood_.log_evidence(chi2(curve_class), 0.0, 0.0) + found.log_shared[curve_class] <
            best - kNegligibleLogOdds) {
      return;
    }
    if (is_same(curve_class)) {
      found.on_reduced_chi2[curve_class] = on_reduced_[curve_class]->chi2;
      found.on_reduced[curve_class] = std::move(before_->on_reduced[curve_class]);
      found.classes[curve_class] = std::move(before_->classes[curve_class]);
    } else {
      add_laplace_evidence(*on_reduced_[curve_class], reduced_, &found, work_);
      auto& evidence = found.classes[curve_class];
      const ClassEvidence* earlier = known_of(*before_, curve_class);
      if (evidence && earlier != nullptr) {
        evidence = at_better_mode(*std::move(evidence), *earlier);
      }
    }
    if (is_wanted(found, curve_class)) {
      best = std::max(best, log_evidence(likelihood_, found, curve_class, chi2(curve_class)));
    }
  }

  /// Whether the class stood in the same fit before.
  bool is_same(CurveClass curve_class) const {
    // Of chi-square: a hundredth of a deviation, to which a fit that is settled again comes back.
    constexpr double kSameFit = 1e-4;
    const auto& chi2_before = before_->on_reduced_chi2[curve_class];
    return before_->classes[curve_class] && chi2_before &&
           std::abs(*chi2_before - on_reduced_[curve_class]->chi2) <= kSameFit;
  }

  /// The bend that the points show of the line, where that has a share in the posterior.
  std::optional<BendOfLine> bend() const {
    constexpr auto kLine = CurveClass::Line;
    return is_seen(CurveClass::Line) && work_.allows()
               ? bend_of_line(*found.classes[kLine], chi2(kLine),
                              points_of(*on_reduced_[kLine], reduced_), likelihood_)
               : std::nullopt;
  }

  bool is_seen(CurveClass curve_class) const {
    return found.classes[curve_class] &&
           log_evidence(likelihood_, found, curve_class, chi2(curve_class)) >
               best - kNegligibleLogOdds;
  }

  double chi2(CurveClass curve_class) const { return fits_[curve_class]->chi2; }

  Evidences found;
  double best;  ///< log of the highest of those that are wanted

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
                       const Likelihood& likelihood, Evidences before, WorkBudget& work,
                       ModesOf modes) {
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
    if (modes == ModesOf::Prior) {
      add_straight_paths(fits, likelihood, *bend, same_line ? &before : nullptr, &laplace.found,
                         work);
    }
    keep_known(before, &laplace.found);
    return std::move(laplace.found);
  }
  for (const CurveClass curve_class : order) {
    laplace.take(curve_class);
  }
  if (modes == ModesOf::Prior) {
    add_prior_modes(fits, reduced, likelihood,
                    log_evidence_of_unclassified(likelihood, laplace.found, smooth.chi2),
                    &laplace.found, work);
    add_limits(fits, reduced, likelihood, laplace.best, before, &laplace.found, work);
  }
  keep_known(before, &laplace.found);
  return std::move(laplace.found);
}

}  // namespace palpate
