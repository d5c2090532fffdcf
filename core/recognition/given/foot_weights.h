// Weights of points and normals whose variance depends on the foot point.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/given/local_points.h"

namespace palpate {

/// Sets the weight of points with a covariance from their variance along the curve's normal at the
/// foot. Sets the weight of measured normals from their own variance plus that of the foot's place:
/// position noise along the curve moves the foot to where the curve's normal has turned. Returns
/// the largest relative change of a weight.
/// For double and DoubleDouble.
template <typename T>
double weigh_at_feet(const PlacedCurve<T>& placed, const LocalPoints& local,
                     std::span<const GivenPoint> points, double default_sigma_m,
                     std::vector<WeighedPoint<T>>* weighed);

}  // namespace palpate
