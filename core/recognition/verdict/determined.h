// How well the shape is known beside its natural size.
#pragma once

#include "core/curves/shape_parameters.h"

namespace palpate {

/// Whether every shape parameter's standard deviation is within `fraction` of its natural size: of
/// the parameter itself, of 1 for slopes, and for a spline's c of the root of `extent_m` (c t
/// against x = t^2).
bool is_determined(const ShapeParameters& shape, const ShapePoseCovariance& covariance,
                   double extent_m, double fraction);

}  // namespace palpate
