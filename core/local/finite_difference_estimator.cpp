#include "core/local/finite_difference_estimator.h"

#include "core/local/five_points.h"

namespace palpate {

LocalResult finite_difference_estimate(std::span<const Vec2> samples, double sigma_m) {
  return five_point_estimate(
      samples, sigma_m, []<typename T>(const std::array<PlanePoint<T>, 5>& p) {
        using std::atan2;
        const PlanePoint<T> before = p[2] - p[0];
        const PlanePoint<T> here = p[3] - p[1];
        const PlanePoint<T> after = p[4] - p[2];
        const T ds_before = length(p[2] - p[1]);
        const T ds_after = length(p[3] - p[2]);
        const T kappa_before = turn(before, here) / ds_before;
        const T kappa_after = turn(here, after) / ds_after;
        const T ds = ds_before + ds_after;
        return std::array<T, 3>{
            atan2(here[1], here[0]),
            (kappa_before * ds_before + kappa_after * ds_after) / ds,  // (51), first
            2.0 * (kappa_after - kappa_before) / ds,                   // (51), second
        };
      });
}

}  // namespace palpate
