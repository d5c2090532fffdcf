// Pose seeds from the tree's leaves: orientation and places are known, the position is a mean.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/curves/pose2.h"
#include "core/invariants/semi_signature_fit.h"
#include "core/recognition/recognition_tree.h"

namespace palpate {

/// Orientation from the fit, position as the mean of (touched point - the curve's point turned).
Pose2 pose_of(std::span<const TreePoint> points, const SemiSignatureFit& fit);

/// Centre as the mean of the points' centres of curvature.
Pose2 circle_pose(std::span<const TreePoint> points, double radius);

/// Along the mean tangent direction (modulo pi) through the mean point.
Pose2 line_pose(std::span<const TreePoint> points);

/// Covariance of the shape parameters within a fit's.
Eigen::Matrix3d shape_covariance(const SemiSignatureFit& fit);

}  // namespace palpate
