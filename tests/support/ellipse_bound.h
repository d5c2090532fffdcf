// Derivatives of the distances to an ellipse by its shape and pose, for bounds on its parameters.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/curves/ellipse.h"
#include "core/curves/pose2.h"

namespace palpate::test {

/// One row per point: the derivatives of its orthogonal distance (positive outside) by a, b, x, y
/// and theta, by central differences.
Eigen::MatrixXd distance_slopes(const Ellipse& ellipse, const Pose2& world_T_ellipse,
                                std::span<const Vec2> points);

}  // namespace palpate::test
