// A curve of known shape and pose as the fits have it.
#pragma once

#include <span>

#include "core/curves/shape_parameters.h"
#include "core/recognition/fit/class_fits.h"

namespace palpate::test {

/// In the data's frame and units; `t`: canonical parameters of the points' feet, one a point. Its
/// chi-square is not that of the points before it is refined.
ClassFit placed_fit(const ShapeParameters& shape, const Pose2& world_T_curve, const FitData& data,
                    std::span<const double> t);

}  // namespace palpate::test
