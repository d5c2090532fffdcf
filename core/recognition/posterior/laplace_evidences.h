// The evidence of every class by Laplace's formula.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/evidences.h"
#include "core/recognition/posterior/likelihood.h"

namespace palpate {

/// Which modes of a class have its evidence: those of its fit alone, which tell nearly which class
/// is best, and where a line is plausible that beside what is better than any path nearly as
/// straight; or also those that the prior leads to, beyond limits, and nearly straight paths.
enum class ModesOf { Fit, Prior };

/// Evidence of the classes fitted to the reduced points, by Laplace's formula; if a line is
/// plausible, also by nearly straight paths, and by these alone where the fit is none better.
/// Classes less probable than a millionth of the best get none. `fits`: with chi-squares of all
/// points. `before`: of the same points; what has not changed is copied.
Evidences evidences_of(const ClassFits& fits, const ClassFits& on_reduced,
                       const SmoothModel& smooth, const FitData& reduced,
                       const Likelihood& likelihood, Evidences before, WorkBudget& work,
                       ModesOf modes = ModesOf::Prior);

}  // namespace palpate
