// Poses from the tree's leaves: the fit gives orientation and curve parameters, the mean of the
// points gives the position.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/curves/pose2.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// Orientation from the fit; position as the mean of (touched point - rotated curve point).
Pose2 pose_of(std::span<const TreePoint> points, const SemiSignatureFit& fit);

/// Localises each point on a curve of that shape (section 5.3) and takes the mean of the poses. The
/// place follows from kappa and kappa_s; for classes that also need the tangent angle, it is taken
/// relative to `frame`, the curve's orientation. nullopt if no point can be localised.
std::optional<Pose2> pose_by_places(const ShapeParameters& shape, std::span<const TreePoint> points,
                                    double frame);

/// The circle that best fits positions and tangents, without curvatures.
struct TangentCircle {
  Pose2 pose;         ///< position = centre
  double chi2 = 0.0;  ///< of the hypothesis that one circle has all these points and tangents
  int dof = 0;        ///< 2 points - 3, minus the points whose side is not known
};

/// Weighted least squares for centre and radius. `radius` [m], from the curvatures, sets the
/// weights of the tangents. `relative_floor`: as RecognitionTreeOptions.
TangentCircle tangent_circle(std::span<const TreePoint> points, double radius,
                             double relative_floor);

/// Through the mean point, along the mean tangent direction (modulo pi).
Pose2 line_pose(std::span<const TreePoint> points);

/// The shape's part of a fit's covariance.
Eigen::Matrix3d shape_covariance(const SemiSignatureFit& fit);

}  // namespace palpate
