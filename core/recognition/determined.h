// How well shape and pose are known beside their natural sizes.
#pragma once

#include "core/recognition/recognition.h"

namespace palpate {

/// Whether every shape parameter's standard deviation is within `fraction` of its natural size: of
/// the parameter itself, of 1 for slopes, and for a spline's c of the root of `extent_m` (c t
/// against x = t^2).
bool is_determined(const ShapeParameters& shape, const ShapePoseCovariance& covariance,
                   double extent_m, double fraction);

/// A component of [shape; x; y; theta].
struct LoosestComponent {
  Eigen::Index index = 0;
  double relative_variance = 0.0;  ///< over the square of its natural size
};

/// The component that is known the least beside its natural size: for the pose, `extent_m` and a
/// radian.
LoosestComponent loosest_component(const ShapeParameters& shape,
                                   const ShapePoseCovariance& covariance, double extent_m);

}  // namespace palpate
