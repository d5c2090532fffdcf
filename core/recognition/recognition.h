// The answer: class, shape, pose and contacts, each with its uncertainty.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"
#include "core/invariants/named_invariant.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/localized_contact.h"
#include "core/recognition/tree/decision.h"

namespace palpate {

enum class RecognitionStatus {
  Collecting,  ///< too little data yet
  Ambiguous,   ///< several classes remain plausible, or the shape is not determined
  Recognized,  ///< one class stands out and its shape is determined
};

/// Why an answer is AMBIGUOUS; the first that applies, in this order.
enum class Doubt {
  None,
  WorkLimit,  ///< the work that an answer may take was spent before all was looked at
              ///< (work_limit.h)
  FormError,  ///< residuals are correlated along the arc: form error, or a class not known here
  SeveralClasses,  ///< no class is probable enough
  AtLimit,         ///< the class fits best where it turns into another
  Misfit,          ///< the residuals are larger than the noise can be
  TwoShapes,       ///< two shapes fit alike (a spline and its rival; tips on either side)
  Undetermined,  ///< the shape's standard deviations are too large, or no covariance describes them
  TreeRejects,   ///< the recognition tree's tests on the local estimates reject the class
  FewPlaces,     ///< touched at so few places that they fit by chance
};

/// Lower-case name with underscores ("several_classes").
std::string_view name_of(Doubt doubt);

/// One class, whether it won or not. The most probable one is refined on all samples; the others on
/// what stands for them (core/README.md, "Refinement and the bound"), those that evidence has ruled
/// out only roughly.
struct Hypothesis {
  ShapeParameters shape;
  Pose2 world_T_curve;
  /// The Kanatani-Cramer-Rao bound; of the most probable hypothesis of RecognitionMethod::
  /// MaximumLikelihood with what the bend of its valley adds (core/README.md, "The posterior") and,
  /// where neighbours err together, what such deviations hide in the shape ("Deviations that
  /// neighbours share").
  ShapePoseCovariance covariance;
  double probability = 0.0;  ///< posterior among all hypotheses, "unclassified" included
  double chi2 = 0.0;         ///< sum of squared normalised residuals of the samples in use
  int dof = 0;
  /// The class has no interior optimum (an ellipse that wants to be a parabola): no shape is given.
  bool at_limit = false;
};

struct Recognition {
  RecognitionStatus status = RecognitionStatus::Collecting;
  Doubt doubt = Doubt::None;  ///< unless AMBIGUOUS
  ShapeParameters shape;
  Pose2 world_T_curve;
  ShapePoseCovariance covariance;      ///< of the most probable hypothesis
  std::vector<Hypothesis> hypotheses;  ///< most probable first
  std::vector<LocalizedContact> contacts;
  std::vector<Decision> decisions;                   ///< the recognition tree's path
  CurveClass tree_class = CurveClass::Unclassified;  ///< where the tree ended
  /// By class, the least p-value of the tree's tests that it must pass; NaN where none was made.
  ClassPValues tree_p_values = no_p_values();
  /// What the tree asked about, pooled over the contacts `pooled_contacts` (indices).
  std::vector<NamedInvariant> invariants;
  std::vector<std::size_t> pooled_contacts;
  std::size_t sample_count = 0;   ///< samples that the answer rests on
  std::size_t outlier_count = 0;  ///< samples set aside as spikes
  /// Samples that repeat a place where the probe stood still, beyond the one, their mean, that
  /// stands for them.
  std::size_t dwelling_count = 0;
  std::size_t forgotten_count = 0;  ///< samples of this object that had to make room for others
  /// Samples of this object with a normal or a covariance of which the answer does not use all: of
  /// a covariance the mean noise counts; a normal counts in full at a touch by itself where every
  /// noise is known, elsewhere the side of a round tip that it shows.
  std::size_t simplified_count = 0;
  double sigma_m = 0.0;              ///< noise of a sample, given or estimated [m]
  double noise_correlation_m = 0.0;  ///< correlation length of the residuals; 0 = white [m]
  /// Of the most probable hypothesis: the covariance that white noise of the stated size leaves,
  /// and what it would be multiplied by were noise that the residuals tell, neighbours that err
  /// together and stated form error so much more white noise.
  ShapePoseCovariance white_covariance;
  double covariance_inflation = 1.0;
  WorkBudget work;  ///< that the answer took, and whether there was more to do
};

}  // namespace palpate
