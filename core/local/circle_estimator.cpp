#include "core/local/circle_estimator.h"

#include "core/local/five_points.h"

namespace palpate {
namespace {

/// Curvature of the circle through three points in order: twice the sine of the angle between the
/// chords, divided by the chord that closes the triangle.
template <typename T>
T circle_curvature(const PlanePoint<T>& p, const PlanePoint<T>& q, const PlanePoint<T>& r) {
  const PlanePoint<T> first = q - p;
  const PlanePoint<T> second = r - q;
  const T area = first[0] * second[1] - first[1] * second[0];
  return 2.0 * area / (length(first) * length(second) * length(r - p));
}

}  // namespace

LocalResult circle_estimate(std::span<const Vec2> samples, double sigma_m) {
  return five_point_estimate(
      samples, sigma_m, []<typename T>(const std::array<PlanePoint<T>, 5>& p) {
        using std::atan2;
        const T a = length(p[2] - p[1]);
        const T b = length(p[3] - p[2]);
        const T d = length(p[1] - p[0]);
        const T g = length(p[4] - p[3]);
        const T kappa_before = circle_curvature(p[0], p[1], p[2]);
        const T kappa_after = circle_curvature(p[2], p[3], p[4]);
        // Tangent at p2, by the inscribed angles: angle(p1 p2) + angle(p2 p3) - angle(p1 p3).
        const PlanePoint<T> first = p[2] - p[1];
        const T tangent = atan2(first[1], first[0]) + turn(p[3] - p[1], p[3] - p[2]);
        return std::array<T, 3>{
            tangent,
            circle_curvature(p[1], p[2], p[3]),
            3.0 * (kappa_after - kappa_before) / (2.0 * a + 2.0 * b + d + g),
        };
      });
}

}  // namespace palpate
