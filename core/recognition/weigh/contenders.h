// Refines the classes that may win on all points until the winner is known.
#pragma once

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// What all classes are compared on.
struct EvidenceContext {
  const Arcs& arcs;
  const FitData& reduced;  ///< the arcs' reduced points, as surface points
  WorkBudget& work;
  Likelihood likelihood;
  double out_of_reach;  ///< chi-square on the reduced points (posterior/out_of_reach.h)
};

struct Contenders {
  ClassFits coarse;  ///< on the reduced points
  ClassFits fits;    ///< plausible ones with chi-square of all points; the best refined on them
  Evidences evidences;
};

/// Chi-square of a class beside which deviations are sought: on all points, or what the reduced
/// points tell where that is more. The difference is no deviation.
double chi2_without_deviation(const Contenders& contenders, const EvidenceContext& context,
                              CurveClass curve_class);

/// Copies the fits to the reduced points, with the chi-square of all points that these imply.
ClassFits with_inferred_chi2(const ClassFits& coarse, const SmoothModel& smooth);

/// The class of the highest evidence, without "unclassified". If none has evidence, the one that
/// fits best; Unclassified if there is none.
CurveClass best_class(const ClassFits& fits, const Likelihood& likelihood,
                      const Evidences& evidences);

ClassProbabilities probabilities_of(const Contenders& contenders, const EvidenceContext& context);

CurveClass most_probable(const ClassProbabilities& probabilities);

/// Adds the evidence of a class about its fit to the reduced points, unless it has that.
void weigh_on_reduced(CurveClass curve_class, const EvidenceContext& context,
                      Contenders* contenders);

/// Computes chi-square on all points for the classes that the reduced points leave plausible, and
/// polishes the best. The others keep the chi-square inferred from the reduced points. Settles the
/// coarse fit of each class that it touches. `margin`: log odds below which the best is not
/// RECOGNIZED.
Contenders refine_plausible(Contenders contenders, const EvidenceContext& context, double margin);

/// Adds the integrals that matter, and takes the most probable class to its optimum on all points.
/// `margin`: as above.
Contenders decided(Contenders contenders, const EvidenceContext& context, double margin);

}  // namespace palpate
