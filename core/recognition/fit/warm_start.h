// What one recognition leaves for the next of the same object.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// The polynomial classes as they were fitted last: a growing patch moves them little.
struct WarmStart {
  PolynomialFits polynomials;
  Pose2 frame;         ///< FitData's, that they were fitted in
  double scale = 1.0;  ///< likewise
  /// No conic has an optimum that was touched, and no ellipse was found that comes near all the
  /// same (weigh/conic_mode.h): not to be looked for again.
  bool no_conic = false;
};

/// One for each way in which the tips were taken to lie beside the patches (tip_sides.h).
struct SidedStart {
  std::vector<int> sides;
  WarmStart start;
};

/// The start for those sides; nullptr where there is none.
const WarmStart* start_for(std::span<const SidedStart> starts, std::span<const int> sides);

/// `fits` on reduced points. Where none of them fits, the next recognition does not search again
/// either: the search has just been made.
WarmStart warm_start_from(const ClassFits& fits, const FitData& reduced);

/// The starts in the frame of `reduced`, each with the parameters of the points' nearest places.
PolynomialFits carried_to(const WarmStart& warm, const FitData& reduced);

}  // namespace palpate
