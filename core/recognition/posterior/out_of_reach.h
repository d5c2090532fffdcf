// The chi-square above which a class cannot change the answer, so that its search may end.
#pragma once

#include "core/recognition/posterior/evidences.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// The chi-square on the reduced points above which a class changes no answer. Free paths are then
/// a million times more probable whatever its prior leaves, and its residuals are too large to be
/// noise or form error, spikes among samples kept as they are, or errors of the directions along
/// which tips are removed. Infinite if only the class can show the noise, or if a patch kept as
/// samples is too short to bound the distance of a spike. `of_paths`: evidences with that of
/// free-form paths.
double out_of_reach(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths);

/// The same where all points lie on a curve as noise lets them, so that none is a spike, and
/// `touches`, the reduced points, have the directions of that curve. `log_evidence`: of what a
/// class must not be hopeless beside.
double out_of_reach(const Arcs& arcs, const FitData& touches, const Likelihood& likelihood,
                    double log_evidence);

}  // namespace palpate
