// The modes of likelihood times prior, by steps downhill.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/posterior/touched_curve.h"

namespace palpate {

/// Work of one curve in touched coordinates: of its points, and of the small systems that are
/// solved beside them, which are six more.
inline std::size_t rows_of_curve(const FitData& data) {
  constexpr std::size_t kRowsOfSystems = 6;
  return data.points.size() + kRowsOfSystems;
}

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

/// Gauss-Newton steps down the potential, coordinate `fixed` (or -1) staying, as far as `work`
/// goes.
TouchedCurve descend(const Touch& touch, const FitData& data, TouchedCurve curve, int fixed,
                     WorkBudget& work, int most_steps = kStepsFromBeside,
                     double settled = kSettledPotential);

/// The mode of likelihood times prior that lies downhill from a curve; nullopt where none comes
/// near the points, and where `start` is no curve of its class in double precision. Noise variances
/// count `inflation` times. `start` need not be an optimum. `least_chi2`: no curve of the class
/// leaves less.
std::optional<TouchedCurve> posterior_mode(const CanonicalFit& start, const FitData& data,
                                           double inflation, double least_chi2, WorkBudget& work);

/// The mode that the prior leads to: from a noise that hides the shape, followed as that is lowered
/// to what it is, as long as it holds more than `log_least`. A fit far out in the prior's tails
/// lies in a valley too narrow and too bent for its noise to be walked along. `start`: its place
/// and feet count.
std::optional<TouchedCurve> followed_from_prior(Touch touch, const FitData& data,
                                                const TouchedCurve& start, double log_least,
                                                WorkBudget& work);

}  // namespace palpate
