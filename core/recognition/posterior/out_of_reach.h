// Where the search for a class may end: what fits so badly changes no answer.
#pragma once

#include "core/recognition/posterior/posterior.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// The chi-square on the reduced points above which a class changes no answer: free paths are the
/// more probable by odds of a million whatever its prior leaves, and what it leaves over is too
/// large to be noise or form error. Infinite where samples may be none of the curve, where the
/// class has to tell the noise, or directions along which tips are taken off. `of_paths`: evidences
/// with that of free-form paths.
double out_of_reach(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths);

}  // namespace palpate
