// The evidence of a class by slices along one shape coordinate, for when the data leave it too wide
// for a normal law. In each slice the other coordinates are at their best.
#pragma once

#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/modes/class_evidence.h"

namespace palpate {

/// The purpose of the slices.
enum class Slices {
  ForMass,    ///< only if the mass differs from that of a normal law
  ForMoment,  ///< also if only the bend of the valley is noticeable compared with its width
};

/// The evidence integrated by slices along the widest coordinate if that is needed, else by
/// Laplace's formula. `evidence`: of the same data, at any inflation. nullopt if it was not at an
/// optimum. At most 29 slices.
std::optional<ClassEvidence> by_slices(ClassEvidence evidence, const FitData& data,
                                       double inflation, Slices slices, WorkBudget& work);

/// The share of the slices' mass that belongs to another mode, at the coordinates `other`: what
/// lies beyond the dip between the two. 0 if the dip is so shallow that a moment about the one
/// holds the other too; nullopt if the slices do not run through it.
std::optional<double> share_of_other_mode(const ClassEvidence& sliced, const TouchedVector& other,
                                          const FitData& data, WorkBudget& work);

}  // namespace palpate
