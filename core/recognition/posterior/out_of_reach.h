// The chi-square above which a class cannot change the answer, so that its search may end.
#pragma once

#include "core/recognition/posterior/posterior.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// The chi-square on the reduced points above which a class changes no answer. Free paths are then
/// a million times more probable whatever its prior leaves, and its residuals are too large to be
/// noise or form error. Infinite if points may be spikes too far from the curve to be bounded, or
/// if only the class can show the noise. It allows for spikes among samples kept as they are and
/// for errors of the directions along which tips are removed. `of_paths`: evidences with that of
/// free-form paths.
double out_of_reach(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths);

}  // namespace palpate
