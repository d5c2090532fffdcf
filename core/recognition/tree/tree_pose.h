// Pose seeds from the tree's leaves: orientation and places are known, the position is a mean.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/curves/pose2.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// Orientation from the fit, position as the mean of (touched point - the curve's point turned).
Pose2 pose_of(std::span<const TreePoint> points, const SemiSignatureFit& fit);

/// Where the places that curvatures (and, in the turned `frame` of the classes that ask for it, the
/// tangent angle) name on a curve of that shape put it: section 5.3, mean over the points. nullopt
/// where they name none.
std::optional<Pose2> pose_by_places(const ShapeParameters& shape, std::span<const TreePoint> points,
                                    double frame);

/// The circle that touched points and tangents say, without their curvatures.
struct TangentCircle {
  Pose2 pose;         ///< its centre
  double chi2 = 0.0;  ///< of "one circle has all these points and tangents"
  int dof = 0;        ///< 2 points - 3, less one a point whose side is not told
};

/// Weighted least squares over centre and radius; `radius` as the curvatures say weighs the
/// tangents' errors. `relative_floor` as in RecognitionTreeOptions.
TangentCircle tangent_circle(std::span<const TreePoint> points, double radius,
                             double relative_floor);

/// Along the mean tangent direction (modulo pi) through the mean point.
Pose2 line_pose(std::span<const TreePoint> points);

/// Covariance of the shape parameters within a fit's.
Eigen::Matrix3d shape_covariance(const SemiSignatureFit& fit);

}  // namespace palpate
