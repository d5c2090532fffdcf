#include "tests/support/ellipse_bound.h"

#include "core/curves/curve.h"

namespace palpate::test {

Eigen::MatrixXd distance_slopes(const Ellipse& ellipse, const Pose2& world_T_ellipse,
                                std::span<const Vec2> points) {
  using Unknowns = Eigen::Matrix<double, 5, 1>;
  const auto distance = [](const Unknowns& q, const Vec2& point) {
    const Pose2 pose{q[2], q[3], q[4]};
    return -foot_point(Curve(Ellipse{q[0], q[1]}), pose.to_local(point)).distance;
  };
  const Unknowns truth{
      {ellipse.a, ellipse.b, world_T_ellipse.x, world_T_ellipse.y, world_T_ellipse.theta}};
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(points.size()), 5);
  for (Eigen::Index k = 0; k < 5; ++k) {
    const double step = 1e-5 * (k < 4 ? ellipse.b : 1.0);
    Unknowns more = truth;
    Unknowns less = truth;
    more[k] += step;
    less[k] -= step;
    for (std::size_t i = 0; i < points.size(); ++i) {
      slopes(static_cast<Eigen::Index>(i), k) =
          (distance(more, points[i]) - distance(less, points[i])) / (2.0 * step);
    }
  }
  return slopes;
}

}  // namespace palpate::test
