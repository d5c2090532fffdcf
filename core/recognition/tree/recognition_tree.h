// The recognition tree of section 5.2: class, shape and place from local estimates alone.
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
  /// Probability that a test rejects the true class, with covariances that are true. Each test's
  /// threshold is the chi-square (or normal) quantile of this.
  double significance = 1e-3;
  /// Standard deviation added to every estimate: radians for the angle, relative to the point's own
  /// size for kappa and kappa_s. Stands for what the estimates' covariance does not know (bias,
  /// form error), and makes exact data testable.
  double relative_floor = 1e-6;
  /// Above zero: the paper's way instead. A test passes where its invariants, over the points or
  /// pairs of points, differ by at most this fraction; covariances are not used.
  double relative_tolerance = 0.0;
};

/// One local estimate and the patch it belongs to: points of a patch share a direction of travel.
struct TreePoint {
  LocalEstimate estimate;
  int patch = 0;
};

struct TreeResult {
  ShapeParameters shape;  ///< Unclassified where every test has failed
  /// Of the shape parameters in use, from the estimates' covariance; infinite where undetermined.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  InvariantStatus status = InvariantStatus::TooFewPoints;  ///< Ok where a class was reached
  double chi2 = 0.0;                                       ///< of the leaf's last test
  int dof = 0;
  std::vector<Decision> decisions;  ///< the path, in order
  /// By class, the least p-value of the tests that it must pass; NaN where none was made.
  ClassPValues p_values = no_p_values();
  /// Of every class that was asked about and has an answer, in the order asked: pooled over the
  /// points `pooled` (indices).
  std::vector<NamedInvariant> invariants;
  std::vector<std::size_t> pooled;
  std::optional<Pose2> world_T_curve;  ///< where shape and tangent angles fix it
  std::vector<LocalParameter> places;  ///< one per point, where world_T_curve is given
};

/// How far the leaves' fits are taken.
struct TreeEffort {
  /// Where the curve of a class lies, as far as it is known from elsewhere. Asked once a class that
  /// the path comes to: its fit begins there, and a class of which nothing is known is refused.
  /// Without it, curves are searched for.
  std::function<std::optional<CurveStart>(CurveClass)> known;
  SemiSignatureOptions fit;
};

/// Tests, in order: line, circle (both beyond the paper); conic line, sign of Ic1 (parabola: Ip),
/// tangent rotation of the conic; cubical parabola; semi-cubical parabola; cubic spline. A conic
/// needs three points, the spline four (three and one that verifies), the other two. A class whose
/// best fit runs away to a neighbour passes where it explains the points on the way, and has no
/// place. Points are
/// taken as independent: neighbouring windows that share samples are not, and make the tests
/// stricter than their significance says.
TreeResult recognise_by_tree(std::span<const TreePoint> points,
                             const RecognitionTreeOptions& options = {},
                             const TreeEffort& effort = {});

/// The leaf that `answer` reached once more, for points near those that it is of: no test on the
/// way there and no search.
TreeResult solve_leaf(std::span<const TreePoint> points, const TreeResult& answer,
                      const RecognitionTreeOptions& options);

}  // namespace palpate
