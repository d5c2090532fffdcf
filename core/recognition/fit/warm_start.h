// The fits that one recognition keeps for the next one of the same object.
#pragma once

#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/polynomial_fits.h"

namespace palpate {

/// Starting values for the polynomial classes: the previous fits. A few new samples change them
/// little.
struct WarmStart {
  PolynomialFits polynomials;
  Pose2 frame;         ///< FitData's frame of these fits
  double scale = 1.0;  ///< FitData's scale of these fits [m]
};

/// The start from `fits` on reduced points. If none of them fits, the next recognition does not
/// search again either: this search has just been made.
WarmStart warm_start_from(const ClassFits& fits, const FitData& reduced);

/// The starts in the frame of `reduced`, with each point's nearest parameter.
PolynomialFits carried_to(const WarmStart& warm, const FitData& reduced);

}  // namespace palpate
