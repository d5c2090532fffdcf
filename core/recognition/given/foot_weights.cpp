#include "core/recognition/given/foot_weights.h"

#include <algorithm>
#include <cmath>

namespace palpate {

template <typename T>
double weigh_at_feet(const PlacedCurve<T>& placed, const LocalPoints& local,
                     std::span<const GivenPoint> points, double default_sigma_m,
                     std::vector<WeighedPoint<T>>* weighed) {
  using std::sqrt;
  double change = 0.0;
  const auto set = [&](const T& variance, T* weight) {
    const T now = T(1.0) / sqrt(variance);
    change = std::max(change, std::abs(to_double((now - *weight) / now)));
    *weight = now;
  };
  for (std::size_t k = 0; k < weighed->size(); ++k) {
    const GivenPoint& point = points[local.index[k]];
    const Eigen::Vector3d& c = point.covariance_m2;
    if (!(c.x() > 0.0) && !has_normal(point)) {
      continue;
    }
    PlaneVector<T> foot = placed.feet[k];
    const auto there = place(placed, placed.to_curve((*weighed)[k].position), &foot);
    if (!(to_double(there.speed) > 0.0) || !(to_double(there.slope) > 0.0)) {
      continue;
    }
    const PlaneVector<T> n = there.normal.x * placed.axis + there.normal.y * left(placed.axis);
    const auto variance_along = [&](const PlaneVector<T>& v) {
      const T unit2(local.unit_m * local.unit_m);  // a power of 2
      if (!(c.x() > 0.0)) {
        const T sigma_m(noise_of(point, default_sigma_m));
        return sigma_m * sigma_m / unit2;
      }
      return (T(c.x()) * v.x * v.x + T(2.0 * c.y()) * v.x * v.y + T(c.z()) * v.y * v.y) / unit2;
    };
    if (c.x() > 0.0) {
      set(variance_along(n), &(*weighed)[k].weight);
    }
    if (has_normal(point)) {
      const T own(point.normal_sigma_rad);
      const T turn = inner(left(there.foot.first), there.foot.second) / (there.speed * there.slope);
      set(own * own + turn * turn * variance_along(left(n)), &(*weighed)[k].normal_weight);
    }
  }
  return change;
}

template double weigh_at_feet<double>(const PlacedCurve<double>&, const LocalPoints&,
                                      std::span<const GivenPoint>, double,
                                      std::vector<WeighedPoint<double>>*);
template double weigh_at_feet<DoubleDouble>(const PlacedCurve<DoubleDouble>&, const LocalPoints&,
                                            std::span<const GivenPoint>, double,
                                            std::vector<WeighedPoint<DoubleDouble>>*);

}  // namespace palpate
