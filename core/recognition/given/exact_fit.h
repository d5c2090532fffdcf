// The last steps of the fit of a given class, in twice the precision of a double.
#pragma once

#include "core/recognition/given/given_search.h"
#include "core/recognition/given/placed/descent.h"

namespace palpate {

struct ExactFit {
  PlacedCurve<DoubleDouble> placed;
  Descent<DoubleDouble> descent;
};

/// Descends from the candidate's curve, with the weights at its feet, to the rounding of a double.
ExactFit exact_fit(const GivenCandidate& found, const LocalPoints& local, const GivenNoise& noise);

PlacedCurve<DoubleDouble> exact_of(const PlacedCurve<double>& curve);
PlacedCurve<double> rounded(const PlacedCurve<DoubleDouble>& exact);

}  // namespace palpate
