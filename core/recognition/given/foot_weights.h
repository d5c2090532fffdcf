// Weights of points and normals whose variance depends on where they lie on the curve.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/given/local_points.h"

namespace palpate {

/// Weighs the points of stated covariance by their variance along the curve's normals at their
/// feet, and measured normals by their own variance and that of the foot's place: noise along the
/// curve puts the foot beside the touch, where the curve has turned on. Returns by what part the
/// weight that changed most did.
double weigh_at_feet(const PlacedCurve<DoubleDouble>& placed, const LocalPoints& local,
                     std::span<const GivenPoint> points, double default_sigma_m,
                     std::vector<WeighedPoint<DoubleDouble>>* exact);

}  // namespace palpate
