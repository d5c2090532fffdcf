// The classes side by side: what may win is refined on all points until it is known what does.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// By how much chi-square on all points may differ from what the reduced points tell where these
/// follow them: a term that a section's polynomial does without has less than the logarithm of its
/// samples (BIC), 4 of 55.
inline constexpr double kLeastError = 4.0;

/// What all classes are judged on.
struct Ground {
  const Arcs& arcs;
  const FitData& reduced;  ///< the arcs' reduced points, as surface points
  WorkBudget& work;
  Likelihood likelihood;
  double out_of_reach;  ///< chi-square on the reduced points (posterior/out_of_reach.h)
};

struct Contenders {
  ClassFits coarse;  ///< on the reduced points
  ClassFits fits;    ///< plausible ones weighed on all points, the best refined there
  Evidences evidences;
  bool no_conic = false;  ///< as WarmStart's
};

/// Fits to the reduced points, as these tell their chi-squares of all points.
ClassFits as_told(const ClassFits& coarse, const SmoothModel& smooth);

/// The class of the highest evidence, "unclassified" aside; where none has any, the one that fits
/// best; Unclassified where there is none.
CurveClass best_class(const ClassFits& fits, const Likelihood& likelihood,
                      const Evidences& evidences);

ClassProbabilities probabilities_of(const Contenders& contenders, const Ground& ground);

CurveClass most_probable(const ClassProbabilities& probabilities);

/// Weighs on all points what the reduced points leave plausible, and polishes the best. The others
/// keep the chi-square that the reduced points tell. `margin`: log odds that keep the best from
/// being RECOGNIZED. The coarse fit of whatever it has to do with is settled.
Contenders refine_plausible(Contenders contenders, const Ground& ground, double margin);

/// With the integrals that matter, and the most probable class at its optimum on all points.
/// `margin`: as above.
Contenders decided(Contenders contenders, const Ground& ground, double margin);

}  // namespace palpate
