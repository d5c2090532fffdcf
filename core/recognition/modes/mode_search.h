// Searches the modes of likelihood times prior by descent.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/modes/touched_curve.h"

namespace palpate {

/// Work of one curve in touched coordinates: of its points, and of the small systems that are
/// solved beside them, which take as much as a dozen more.
inline std::size_t rows_of_curve(const FitData& data) {
  constexpr std::size_t kRowsOfSystems = 12;
  return data.points.size() + kRowsOfSystems;
}

/// -log of likelihood times prior.
double potential(const TouchedCurve& curve);

/// log of the determinant of root root^T.
double log_determinant(const TouchedMatrix& root);

/// The curve's root with coordinate `fixed` held (-1: none).
TouchedMatrix root_of(const TouchedCurve& curve, int fixed);

/// How many coordinates the data determine at the end of a descent: the prior's share of each is
/// its variance, in units of the widths.
double determined_coordinates(const TouchedCurve& settled);

/// log of the integral about the mode beside `settled`, the end of a descent, by Laplace's formula,
/// with all coordinates but `fixed` (-1: none) in units of the widths.
double log_mass(const TouchedCurve& settled, int fixed = -1);

/// Most steps of a descent. From a neighbouring slice the mode is near. From the optimum of the
/// likelihood it may be far if the data determine little. These limits bound the time: descents end
/// by themselves once the potential is settled, and a mode that is farther is searched from the
/// prior (followed_from_prior).
inline constexpr int kStepsFromBeside = 4;
inline constexpr int kStepsFromFit = 8;

/// Left to gain of the potential at which a descent ends that odds are asked of: a third of a
/// deviation from the mode. It is counted as the linear model has it (log_mass). Most odds are then
/// right to a fiftieth. Some valleys go down farther than the model tells, and bend on the way:
/// what Laplace's formula leaves out of these is more than what their ends would add.
inline constexpr double kSettledPotential = 5e-2;

/// The same where the place itself is asked for: a fifth of a deviation.
inline constexpr double kSettledPlace = 2e-2;

/// Gauss-Newton steps down the potential, with coordinate `fixed` held (-1: none).
TouchedCurve descend(const Touch& touch, const FitData& data, TouchedCurve curve, int fixed,
                     WorkBudget& work, int most_steps, double settled = kSettledPotential);

/// The mode that a shape of the prior leads to (prior_starts.h), if it holds more than `log_least`.
/// The noise is lowered step by step from what the shape leaves to its true value. Reason: a fit
/// far out in the prior's tails lies in a valley that is too narrow and bent to be walked along.
std::optional<TouchedCurve> followed_from_prior(Touch touch, const FitData& data,
                                                const TouchedCurve& start, double log_least,
                                                WorkBudget& work);

}  // namespace palpate
