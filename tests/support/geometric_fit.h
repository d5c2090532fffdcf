// Least squares of point distances to a canonical curve: a simple reference that uses all points
// and a given start.
#pragma once

#include <span>

#include "core/curves/curve.h"

namespace palpate::test {

struct PlacedShape {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  Pose2 world_T_curve;
};

/// Sum of squared distances of the points to the curve; infinite for an invalid shape. [m^2]
double squared_distances(const PlacedShape& placed, std::span<const Vec2> points);

/// Moves shape and pose to a minimum of squared_distances by damped Gauss-Newton steps and returns
/// the minimum. The shape parameter `fixed` (0 to 2) keeps its value; -1 = none is fixed.
double refine_geometrically(std::span<const Vec2> points, PlacedShape* placed, int fixed = -1);

}  // namespace palpate::test
