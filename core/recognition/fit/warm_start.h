// What one recognition leaves for the next of the same object.
#pragma once

#include <optional>
#include <vector>

#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// The polynomial classes as they were fitted last: a growing patch moves them little.
struct WarmStart {
  PolynomialFits polynomials;
  Pose2 frame;         ///< FitData's, that they were fitted in
  double scale = 1.0;  ///< likewise
};

/// One for each way in which the tips were taken to lie beside the patches (tip_sides.h).
struct SidedStart {
  std::vector<int> sides;
  WarmStart start;
};

/// `fits` on reduced points. Where none of them fits, the next recognition does not search again
/// either: the search has just been made.
WarmStart warm_start_from(const ClassFits& fits, const FitData& reduced);

/// The starts in the frame of `reduced`, each with the parameters of the points' nearest places.
PolynomialFits carried_to(const WarmStart& warm, const FitData& reduced);

}  // namespace palpate
