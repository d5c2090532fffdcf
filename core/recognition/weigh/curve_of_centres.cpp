#include "core/recognition/weigh/curve_of_centres.h"

#include <utility>

#include "core/recognition/fit/on_all_points.h"

namespace palpate {
namespace {

/// The conic that fits the centres best, where one fits them as noise lets it: a cubic through few
/// of them turns between, and it is the normals that are asked for.
std::optional<ClassFit> conic_that_fits(const ClassFits& fits, const FitData& centres,
                                        WorkBudget& work) {
  const ClassFit* best = nullptr;
  for (const auto& fit : fits) {
    const bool conic = fit && !fit->at_limit && (kCubics & class_bit(fit->curve_class)) == 0;
    if (conic && fits_well(fit->chi2, residual_count(centres)) &&
        (best == nullptr || fit->chi2 < best->chi2)) {
      best = &*fit;
    }
  }
  return best != nullptr ? std::optional(settled(*best, centres, RivalOf::Other, work))
                         : std::nullopt;
}

}  // namespace

const std::optional<CanonicalFit>& CurveOfCentres::get() {
  if (!sought_) {
    sought_ = true;
    const FitData& centres = by_.arcs.smooth.reduced;
    SideChoice choice;
    choice.fits = fit_classes_from(starts_, sides_, centres, by_);
    choice.reduced = centres;
    choice.evidences = by_.of_paths;
    settle_candidate(by_, ModesOf::Prior, &choice);
    const bool may_turn = (kCubics & class_bit(choice.candidate)) != 0;
    const auto conic = may_turn ? conic_that_fits(choice.fits, centres, by_.work) : std::nullopt;
    const auto& best = conic ? conic : choice.settled;
    curve_ = best ? to_canonical(*best, centres) : std::nullopt;
    start_ = warm_start_from(choice.fits, centres);
    fits_ = std::move(choice.fits);
  }
  return curve_;
}

}  // namespace palpate
