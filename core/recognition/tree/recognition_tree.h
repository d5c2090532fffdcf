// The recognition tree of section 5.2: class, shape and pose from local estimates alone.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"
#include "core/invariants/invariant_status.h"
#include "core/invariants/named_invariant.h"
#include "core/invariants/signature_fit/local_parameter.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/local/local_estimate.h"
#include "core/recognition/tree/decision.h"

namespace palpate {

struct RecognitionTreeOptions {
  /// Probability that a test rejects the true class if the covariances are correct. Each test's
  /// threshold is the chi-square (or normal) quantile for it.
  double significance = 1e-3;
  /// Standard deviation added to every estimate: in radians for the angle, relative to the point's
  /// own curvature scale for kappa and kappa_s. It stands for errors that the estimates' covariance
  /// does not know (bias, form error) and makes exact data testable.
  double relative_floor = 1e-6;
  /// > 0: uses the paper's tests instead (recognition_tree_tolerance.h). A test passes if its
  /// invariants differ by at most this fraction over the points or pairs of points. Covariances are
  /// not used.
  double relative_tolerance = 0.0;
};

/// One local estimate and its patch. The points of a patch share a direction of travel.
struct TreePoint {
  LocalEstimate estimate;
  int patch = 0;
};

struct TreeResult {
  ShapeParameters shape;  ///< Unclassified if every class failed a test
  /// Of the shape parameters in use, from the estimates' covariance; infinite if undetermined.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  InvariantStatus status = InvariantStatus::TooFewPoints;  ///< Ok if a class was reached
  double chi2 = 0.0;                                       ///< of the last test
  int dof = 0;
  std::vector<Decision> decisions;  ///< the tests, in order
  /// By class: smallest p-value of the tests that the class must pass; NaN without a test.
  ClassPValues p_values = no_p_values();
  /// Invariants of every tested class that has them, in the order of the tests, from the points
  /// `pooled` (indices).
  std::vector<NamedInvariant> invariants;
  std::vector<std::size_t> pooled;
  std::optional<Pose2> world_T_curve;  ///< if shape and tangent angles determine it
  std::vector<LocalParameter> places;  ///< one per point if world_T_curve is given by a fit
};

/// Where the fits at the leaves start and how far they are refined.
struct TreeEffort {
  /// If set, gives the fit of a class its start from a curve known already. It is called once per
  /// class that the path reaches; a class without a known curve is refused. If not set, the tree
  /// searches.
  std::function<std::optional<CurveStart>(CurveClass)> known;
  SemiSignatureOptions fit;
};

/// Tests, in order: line and circle (not in the paper); conic line; sign of Ic1 (parabola: Ip);
/// tangent rotation of the conic; cubical parabola; semi-cubical parabola; cubic spline. A conic
/// needs three points, the spline four (three and one to verify), the other classes two. A class
/// whose fit runs away to a neighbouring class passes if it explains the points on the way; it then
/// has no pose. Points are assumed independent: windows that share samples are not, and make the
/// tests stricter than their significance.
TreeResult recognise_by_tree(std::span<const TreePoint> points,
                             const RecognitionTreeOptions& options = {},
                             const TreeEffort& effort = {});

/// Solves again the leaf that `answer` reached, for points near those of `answer`: without the
/// tests on the way and without a search.
TreeResult solve_leaf(std::span<const TreePoint> points, const TreeResult& answer,
                      const RecognitionTreeOptions& options);

}  // namespace palpate
