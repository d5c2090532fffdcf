// Modes of a class that its own fit does not lead to: the prior does, or another class's mode.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/modes/class_evidence.h"

namespace palpate {

/// The evidence at the mode that is reached from the prior, if it is larger than `evidence` and
/// than `least` (log of what the prior leaves of the likelihood). A fit may lie far out in the
/// prior's tails, in a valley that is too long and bent to be walked along, while another place of
/// the valley fits as well and is expected by the prior. Shapes of the prior are laid along `path`,
/// a curve near the points: the fit's own, or another class's.
ClassEvidence with_prior_mode(ClassEvidence evidence, const ClassEvidence& path,
                              const FitData& data, double least, WorkBudget& work);

/// The evidence of a class at the best mode that the prior leads to along `path`, another class's.
/// `fitted_chi2`: the chi-square that `log_occam` counts from; `least`: as with_prior_mode's.
/// nullopt if no mode has as much.
std::optional<ClassEvidence> from_prior(CurveClass curve_class, double fitted_chi2,
                                        const ClassEvidence& path, const FitData& data,
                                        double least, WorkBudget& work);

/// The spline's evidence at the mode that it has at c = 0, where the semi-cubical parabola has its
/// own, if that holds more. Slices and searches may miss it: the valley between is long.
ClassEvidence with_mode_at_cusp(ClassEvidence spline, const ClassEvidence& semi_cubical,
                                const FitData& data, WorkBudget& work);

/// The same at the mode that it has beside the parabola: an arc with next to no third derivative.
/// The best fit, and what the prior leads to from there, may lie far along a flat valley.
ClassEvidence with_mode_at_parabola(ClassEvidence spline, const ClassEvidence& parabola,
                                    const FitData& data, WorkBudget& work);

}  // namespace palpate
