#include "tests/support/geometric_fit.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace palpate::test {
namespace {

PlacedShape moved(const PlacedShape& from, const Eigen::VectorXd& step, Eigen::Index letters) {
  PlacedShape to = from;
  to.values.head(letters) += step.head(letters);
  to.world_T_curve.x += step[letters];
  to.world_T_curve.y += step[letters + 1];
  to.world_T_curve.theta += step[letters + 2];
  return to;
}

}  // namespace

double squared_distances(const PlacedShape& placed, std::span<const Vec2> points) {
  const auto curve = make_curve(placed.curve_class, placed.values);
  if (!curve) {
    return std::numeric_limits<double>::infinity();
  }
  double sum = 0.0;
  for (const Vec2& point : points) {
    const double distance = foot_point(*curve, placed.world_T_curve.to_local(point)).distance;
    sum += distance * distance;
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

double refine_geometrically(std::span<const Vec2> points, PlacedShape* placed, int fixed) {
  constexpr int kMostSteps = 60;
  constexpr double kEnough = 1e-6;  // relative decrease of the sum in one step
  constexpr double kMostDamping = 1e12;
  const auto letters = static_cast<Eigen::Index>(parameter_letters(placed->curve_class).size());
  const Eigen::Index unknowns = letters + 3;
  double sum = squared_distances(*placed, points);
  double damping = 1e-4;
  for (int i = 0; i < kMostSteps && std::isfinite(sum) && sum > 0.0; ++i) {
    const Curve curve = *make_curve(placed->curve_class, placed->values);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(unknowns);
    for (const Vec2& point : points) {
      const Vec2 local = placed->world_T_curve.to_local(point);
      const double t = foot_point(curve, local).t;
      const CurveDerivatives d = derivatives(curve, t);
      if (!(d.first.norm() > 0.0)) {
        continue;  // a cusp has no normal
      }
      const Vec2 along_normal = left_of(d.first).normalized();
      const double distance = along_normal.dot(local - d.position);
      Eigen::VectorXd row(unknowns);
      row.head(letters) =
          (along_normal.transpose() * position_by_parameters(curve, t)).transpose().head(letters);
      row.segment<2>(letters) = placed->world_T_curve.rotate(along_normal);
      row[letters + 2] = along_normal.dot(left_of(local));
      if (fixed >= 0) {
        row[fixed] = 0.0;
      }
      normal += row * row.transpose();
      gradient += distance * row;
    }
    // Parameters without effect on the data (a line's sliding) keep their values.
    const double floor = 1e-14 * normal.diagonal().maxCoeff();
    bool better = false;
    double before = sum;
    while (!better && damping < kMostDamping) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() += damping * normal.diagonal();
      damped.diagonal().array() += std::numeric_limits<double>::min() + floor * 1e-6;
      const PlacedShape next = moved(*placed, damped.ldlt().solve(gradient), letters);
      const double lower = squared_distances(next, points);
      better = lower < sum;
      if (better) {
        *placed = next;
        sum = lower;
        damping = std::max(0.1 * damping, 1e-12);
      } else {
        damping *= 10.0;
      }
    }
    if (!better || before - sum < kEnough * before) {
      break;
    }
  }
  return sum;
}

}  // namespace palpate::test
