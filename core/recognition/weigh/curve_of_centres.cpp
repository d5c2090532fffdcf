#include "core/recognition/weigh/curve_of_centres.h"

namespace palpate {

const std::optional<CanonicalFit>& CurveOfCentres::get() {
  if (!sought_) {
    sought_ = true;
    const FitData& centres = by_.arcs.smooth.reduced;
    SideChoice choice;
    choice.fits = fit_classes_from(starts_, sides_, centres, by_);
    choice.reduced = centres;
    choice.evidences = by_.of_paths;
    settle_candidate(by_, &choice);
    curve_ = choice.settled ? to_canonical(*choice.settled, centres) : std::nullopt;
    start_ = warm_start_from(choice.fits, centres);
  }
  return curve_;
}

}  // namespace palpate
