#include "core/recognition/given/foot_weights.h"

#include <algorithm>
#include <cmath>

namespace palpate {

double weigh_at_feet(const PlacedCurve<DoubleDouble>& placed, const LocalPoints& local,
                     std::span<const GivenPoint> points, double default_sigma_m,
                     std::vector<WeighedPoint<DoubleDouble>>* exact) {
  double change = 0.0;
  const auto set = [&](const DoubleDouble& variance, DoubleDouble* weight) {
    const DoubleDouble now = DoubleDouble(1.0) / sqrt(variance);
    change = std::max(change, std::abs(to_double((now - *weight) / now)));
    *weight = now;
  };
  for (std::size_t k = 0; k < exact->size(); ++k) {
    const GivenPoint& point = points[local.index[k]];
    const Eigen::Vector3d& c = point.covariance_m2;
    if (!(c.x() > 0.0) && !has_normal(point)) {
      continue;
    }
    PlaneVector<DoubleDouble> foot = placed.feet[k];
    const auto there = place(placed, placed.to_curve((*exact)[k].position), &foot);
    if (!(to_double(there.speed) > 0.0) || !(to_double(there.slope) > 0.0)) {
      continue;
    }
    const PlaneVector<DoubleDouble> n =
        there.normal.x * placed.axis + there.normal.y * left(placed.axis);
    const auto variance_along = [&](const PlaneVector<DoubleDouble>& v) {
      const DoubleDouble unit2(local.unit_m * local.unit_m);  // a power of 2
      if (!(c.x() > 0.0)) {
        const DoubleDouble sigma_m(noise_of(point, default_sigma_m));
        return sigma_m * sigma_m / unit2;
      }
      return (DoubleDouble(c.x()) * v.x * v.x + DoubleDouble(2.0 * c.y()) * v.x * v.y +
              DoubleDouble(c.z()) * v.y * v.y) /
             unit2;
    };
    if (c.x() > 0.0) {
      set(variance_along(n), &(*exact)[k].weight);
    }
    if (has_normal(point)) {
      const DoubleDouble own(point.normal_sigma_rad);
      const DoubleDouble turn =
          inner(left(there.foot.first), there.foot.second) / (there.speed * there.slope);
      set(own * own + turn * turn * variance_along(left(n)), &(*exact)[k].normal_weight);
    }
  }
  return change;
}

}  // namespace palpate
