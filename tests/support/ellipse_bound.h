// How the distances to an ellipse change with its shape and pose: what any bound on them is made
// of.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/curves/ellipse.h"
#include "core/curves/pose2.h"

namespace palpate::test {

/// A row a point: derivatives of its orthogonal distance, out of the ellipse, by a, b, x, y and
/// theta. By central differences.
Eigen::MatrixXd distance_slopes(const Ellipse& ellipse, const Pose2& world_T_ellipse,
                                std::span<const Vec2> points);

}  // namespace palpate::test
