// The curve parameter of a point from its local geometry, section 5.3 in sign-safe forms: the start
// of a fit, for a given shape and orientation.
#pragma once

#include <Eigen/Core>

#include "core/curves/curve_class.h"

namespace palpate {

struct LocalParameter {
  double t = 0.0;
  int direction = 1;  ///< +1: travelled with t increasing, -1: against it
};

/// `angle`: tangent angle in the canonical frame in the direction of travel; kappa and kappa_s of
/// that direction. Always finite, for any finite input: where the geometry does not fit the shape
/// it is a nearby parameter. Not for lines and circles.
LocalParameter local_parameter(CurveClass curve_class, const Eigen::Vector3d& parameters,
                               double angle, double kappa, double kappa_s);

}  // namespace palpate
