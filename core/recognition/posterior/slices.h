// The marginal likelihood of a class where the data leave one coordinate of its shape too wide for
// a normal law: slices along that coordinate, each with the others at their best.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/posterior/class_evidence.h"

namespace palpate {

/// What slices are for.
enum class Slices {
  ForMass,    ///< where it is not that of a normal law
  ForMoment,  ///< also where only the valley's bend shows, beside how narrow it is
};

/// The same evidence, integrated by slices along the coordinate that is left the widest, where that
/// takes any; by Laplace's formula where not. `evidence`: of the same data, at any inflation.
/// nullopt where it turns out to be that of no optimum. At most some forty slices, and no more than
/// `work` goes on.
std::optional<ClassEvidence> by_slices(ClassEvidence evidence, const FitData& data,
                                       double inflation, Slices slices, WorkBudget& work);

}  // namespace palpate
