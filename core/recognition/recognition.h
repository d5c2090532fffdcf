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
  Collecting,  ///< too few data for an answer
  Ambiguous,   ///< there is an answer, and a doubt about it
  Recognized,  ///< one class is probable enough and its shape is determined
};

/// Why an answer is AMBIGUOUS: the first reason that applies, in this order. (Misfit comes before
/// AtLimit if more than a tenth of the samples were set aside as spikes.)
enum class Doubt {
  None,
  WorkLimit,  ///< the work that an answer may take was spent before all was looked at
              ///< (work_limit.h)
  FormError,  ///< residuals are correlated along the arc: form error, or a class not known here
  SeveralClasses,  ///< no class is probable enough
  AtLimit,         ///< the best fit lies where the class turns into another one
  Misfit,          ///< the residuals are larger than the noise can be
  TwoShapes,     ///< two shapes fit about equally well (a spline's two shapes; tips on either side)
  Undetermined,  ///< a shape parameter's standard deviation is too large, or not known
  TreeRejects,   ///< the recognition tree's tests on the local estimates reject the class
  FewPlaces,     ///< so few places were touched that a class may fit them by chance
};

/// Lower-case name with underscores ("several_classes").
std::string_view name_of(Doubt doubt);

/// One class and its fit. The most probable class is refined on all samples, the others on the
/// reduced points (core/README.md, "Refinement and the bound"), and classes that the evidence has
/// ruled out only roughly.
struct Hypothesis {
  ShapeParameters shape;
  Pose2 world_T_curve;
  /// Of [shape; x; y; theta]. The Kanatani-Cramer-Rao bound. For the most probable hypothesis of
  /// RecognitionMethod::MaximumLikelihood it also includes the curvature of the chi-square valley
  /// (core/README.md, "The posterior") and, where residuals are correlated, what such deviations
  /// may hide in the shape ("Deviations that neighbours share").
  ShapePoseCovariance covariance;
  double probability = 0.0;  ///< posterior; all hypotheses with "unclassified" sum to 1
  double chi2 = 0.0;         ///< sum of squared normalised residuals of the samples in use
  int dof = 0;
  /// The class has no interior optimum (e.g. the best ellipse is a parabola): no shape is given.
  bool at_limit = false;
};

struct Recognition {
  RecognitionStatus status = RecognitionStatus::Collecting;
  Doubt doubt = Doubt::None;  ///< None unless AMBIGUOUS
  ShapeParameters shape;
  Pose2 world_T_curve;
  ShapePoseCovariance covariance;      ///< of the most probable hypothesis
  std::vector<Hypothesis> hypotheses;  ///< most probable first
  std::vector<LocalizedContact> contacts;
  std::vector<Decision> decisions;                   ///< path through the recognition tree
  CurveClass tree_class = CurveClass::Unclassified;  ///< where that path ended
  /// By class: smallest p-value of the tests that the class must pass; NaN without a test.
  ClassPValues tree_p_values = no_p_values();
  /// Invariants that the tree computed, from all of the contacts `pooled_contacts` (indices).
  std::vector<NamedInvariant> invariants;
  std::vector<std::size_t> pooled_contacts;
  std::size_t sample_count = 0;   ///< samples in memory, outliers included
  std::size_t outlier_count = 0;  ///< samples set aside as spikes
  std::vector<Vec2> outliers_m;   ///< their positions, of means of neighbours the mean's
  /// Samples that only repeat a place where the probe stood still. One sample, their mean, stands
  /// for them; it is not counted here.
  std::size_t dwelling_count = 0;
  std::size_t forgotten_count = 0;  ///< samples of this object dropped to make room for others
  /// Samples of this object whose normal or covariance is used only in part in shape, pose and
  /// their covariance. All of it is used if every noise is known and the class is found by
  /// likelihood, except normals along strokes where neighbours err together, and single normals
  /// beyond any noise. (The odds of the classes include covariances, and normals of single
  /// touches.)
  std::size_t simplified_count = 0;
  /// Noise of a sample, stated or estimated; of one with a covariance, across the curve. Estimated
  /// where a probe was held at places, that of the means that stand for these: nothing says that
  /// its readings there err independently. [m]
  double sigma_m = 0.0;
  double noise_correlation_m = 0.0;  ///< over which neighbours err together; 0 = white noise [m]
  /// Of the most probable hypothesis: its covariance if all noise is white and of the stated size.
  ShapePoseCovariance white_covariance;
  /// Factor on white_covariance if larger noise, correlated residuals and stated form error are all
  /// counted as additional white noise.
  double covariance_inflation = 1.0;
  /// True if covariance and probabilities contain what a probe that nobody has measured may hide
  /// (RecognizerOptions::unqualified_probe).
  bool unqualified_probe = false;
  WorkBudget work;  ///< that the answer took, and whether there was more to do
};

/// What speaks against an answer that nothing has spoken against yet: RECOGNIZED becomes AMBIGUOUS.
void add_doubt(Doubt doubt, Recognition* answer);

/// Covariance of the most probable hypothesis if the probe errs by noise alone. Empty if there is
/// none.
ShapePoseCovariance noise_covariance(const Recognition& recognition);

}  // namespace palpate
