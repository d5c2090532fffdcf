// A curve of known shape and pose in the form of a fit's result.
#pragma once

#include <span>

#include "core/curves/shape_parameters.h"
#include "core/recognition/fit/class_fits.h"

namespace palpate::test {

/// In the frame and units of the data. `t`: canonical parameters of the foot points, one per point.
/// Its chi-square is not valid before it is refined.
ClassFit placed_fit(const ShapeParameters& shape, const Pose2& world_T_curve, const FitData& data,
                    std::span<const double> t);

}  // namespace palpate::test
