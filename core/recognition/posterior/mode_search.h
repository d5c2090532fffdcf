// The modes of likelihood times prior, by steps downhill.
#pragma once

#include <optional>

#include "core/recognition/posterior/touched_curve.h"

namespace palpate {

/// -log of likelihood times prior.
double potential(const TouchedCurve& curve);

/// Of what `root` is the root of.
double log_determinant(const TouchedMatrix& root);

/// log of the integral about a mode by Laplace's formula, all coordinates in units of the widths.
double log_mass(const TouchedCurve& mode);

/// The curve's root with coordinate `fixed` (or -1) not moving.
TouchedMatrix root_of(const TouchedCurve& curve, int fixed);

/// From the slice beside, the mode is near; from the optimum of the likelihood it may be far, where
/// the data determine little. Bounds of the time: steps end by themselves where the potential is
/// settled, and what is too far for so many is sought from the prior (followed_from_prior).
inline constexpr int kStepsFromBeside = 4;
inline constexpr int kStepsFromFit = 8;

/// Of the potential, where steps end: odds right to a fiftieth.
inline constexpr double kSettledPotential = 2e-2;

/// Gauss-Newton steps down the potential, coordinate `fixed` (or -1) staying.
TouchedCurve descend(const Touch& touch, const FitData& data, TouchedCurve curve, int fixed,
                     int most_steps = kStepsFromBeside, double settled = kSettledPotential);

/// The mode of likelihood times prior that lies downhill from a curve; nullopt where none comes
/// near the points, and where `start` is no curve of its class in double precision. Noise variances
/// count `inflation` times. `start` need not be an optimum. `least_chi2`: no curve of the class
/// leaves less.
std::optional<TouchedCurve> posterior_mode(const CanonicalFit& start, const FitData& data,
                                           double inflation, double least_chi2);

/// The mode that a shape of the prior leads to (prior_starts.h), if it holds more than `log_least`:
/// the noise is lowered from what the shape leaves to what it is. A fit far out in the prior's
/// tails lies in a valley too narrow and too bent for its noise to be walked along.
std::optional<TouchedCurve> followed_from_prior(Touch touch, const FitData& data,
                                                const TouchedCurve& start, double log_least);

}  // namespace palpate
