// Tests whether the shape is known precisely enough.
#pragma once

#include "core/curves/shape_parameters.h"

namespace palpate {

/// True if every shape parameter's standard deviation is at most `fraction` of its natural size.
/// That size is |parameter|. For slopes (c of the cubical parabola, b of the semi-cubical parabola
/// and of the spline) it is at least 1, for the spline's c at least sqrt(extent_m), because c t is
/// compared with x = t^2. `extent_m`: half extent of the samples [m].
bool is_determined(const ShapeParameters& shape, const ShapePoseCovariance& covariance,
                   double extent_m, double fraction);

}  // namespace palpate
