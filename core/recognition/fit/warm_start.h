// What one recognition keeps for the next one of the same object.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// Starting values for the polynomial classes: the previous fits. A few new samples change them
/// little.
struct WarmStart {
  PolynomialFits polynomials;
  Pose2 frame;         ///< FitData's frame of these fits
  double scale = 1.0;  ///< FitData's scale of these fits [m]
  /// True if no conic has an optimum that a probe could have touched, and no ellipse was found
  /// nearby instead (weigh/conic_mode.h): it is not searched again.
  bool no_conic = false;
};

/// A start for one choice of the tips' sides, one per patch (tip_sides.h).
struct SidedStart {
  std::vector<int> sides;
  WarmStart start;
};

/// The start for those sides; nullptr if there is none.
const WarmStart* start_for(std::span<const SidedStart> starts, std::span<const int> sides);

/// The start from `fits` on reduced points. If none of them fits, the next recognition does not
/// search again either: this search has just been made.
WarmStart warm_start_from(const ClassFits& fits, const FitData& reduced);

/// The starts in the frame of `reduced`, with each point's nearest parameter.
PolynomialFits carried_to(const WarmStart& warm, const FitData& reduced);

}  // namespace palpate
