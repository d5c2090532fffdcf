// Class fits found on the reduced points, against all points: tip radii and all.
#pragma once

#include <optional>

#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// Whether a fit to `data` is still the curve that it is called, and one that can be touched so.
bool is_what_it_says(const ClassFit& fit, const FitData& data);

/// A spline's rival far behind it may still come near: that makes the shape doubtful, which matters
/// to the best class alone.
enum class RivalOf { Best, Other };

/// Takes a fit on the reduced points to its optimum there.
ClassFit settled(const ClassFit& fit, const FitData& reduced, RivalOf rival, WorkBudget& work);

/// Chi-square of all points about a fit on the reduced ones as it is. O(points).
double chi2_on_all(const ClassFit& fit, const SmoothModel& smooth, const FitData& data,
                   WorkBudget& work);

/// Refines a fit on the reduced points, best a settled one, on all; nullopt if its optimum there is
/// no such curve (an ellipse that turned into a hyperbola or into a needle around straight points).
/// O(points) per iteration.
std::optional<ClassFit> refine_on_all(const ClassFit& fit, const SmoothModel& smooth,
                                      const FitData& data, const RefineEffort& effort,
                                      WorkBudget& work);

/// Takes a fit on all points to its optimum as far as rounding goes; nullopt as above. O(points)
/// per iteration.
std::optional<ClassFit> polish(const ClassFit& fit, const FitData& data, WorkBudget& work);

}  // namespace palpate
