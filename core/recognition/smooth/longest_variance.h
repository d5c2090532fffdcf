// A point's noise where nothing tells in which direction it counts.
#pragma once

#include <cmath>
#include <cstddef>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Variance of a point's noise in the direction in which it is longest.
inline double longest_variance(const FitData& data, std::size_t point) {
  if (!data.details.empty() && data.details[point].covariance.x() > 0.0) {
    const Eigen::Vector3d& c = data.details[point].covariance;
    return 0.5 * (c.x() + c.z()) + std::hypot(0.5 * (c.x() - c.z()), c.y());
  }
  const double inverse = data.points[point].inverse_sigma;
  return 1.0 / (inverse * inverse);
}

}  // namespace palpate
