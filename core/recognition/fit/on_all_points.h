// Takes class fits from the reduced points to all points, tip radii included.
#pragma once

#include <optional>

#include "core/recognition/fit/class_fits.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// True if a fit to `data` is still a curve of its class, and one that a probe could have touched.
bool is_what_it_says(const ClassFit& fit, const FitData& data);

/// Whether the fit is the best class. A spline's rival that is far worse may still come near in the
/// refinement; the doubtful shape then matters only for the best class.
enum class RivalOf { Best, Other };

/// Refines a fit to its optimum on the reduced points.
ClassFit settled(const ClassFit& fit, const FitData& reduced, RivalOf rival, WorkBudget& work);

/// Refines a fit on the centres of tips that lie on that side of it: +1 where the polynomial is
/// positive, or left of increasing t, -1 on the other. `fit.polynomial->t` must be near the
/// centres' feet. Leaves out a spline's rival.
ClassFit beside_centres(ClassFit fit, int side, const FitData& centres, const RefineEffort& effort,
                        WorkBudget& work);

/// Chi-square of all points for an unchanged fit to the reduced points. O(points).
double chi2_on_all(const ClassFit& fit, const SmoothModel& smooth, const FitData& data,
                   WorkBudget& work);

/// The fit as it is, with chi-square of all points, if that tells what the reduced points do and
/// the fit is such a curve. O(points).
std::optional<ClassFit> where_all_agree(const ClassFit& settled, const FitData& reduced,
                                        const SmoothModel& smooth, const FitData& data,
                                        WorkBudget& work);

/// Refines a fit to the reduced points, preferably a settled one, on all points. nullopt if its
/// optimum there is not such a curve (an ellipse that turned into a hyperbola, or into a needle
/// around straight points). Where reduced points do not fit the best class, that may be due to
/// them: its feet are sought anew. O(points) per iteration.
std::optional<ClassFit> refine_on_all(const ClassFit& fit, const SmoothModel& smooth,
                                      const FitData& data, const RefineEffort& effort,
                                      WorkBudget& work, RivalOf rival = RivalOf::Other);

/// Refines a fit on all points to its optimum, up to rounding; nullopt as above. O(points) per
/// iteration.
std::optional<ClassFit> polish(const ClassFit& fit, const FitData& data, WorkBudget& work);

}  // namespace palpate
