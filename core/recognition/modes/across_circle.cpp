#include "core/recognition/modes/across_circle.h"

#include <cmath>
#include <numbers>

#include "core/numerics/matrices/symmetric_eigen.h"

namespace palpate {
namespace {

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat5 = Eigen::Matrix<double, 5, 5>;

/// [mean radius; ovality; centre] of [a; b; x; y; theta], to first order: the Jacobian.
Mat5 by_ellipse(double ovality, double theta) {
  const double c = std::cos(2.0 * theta);
  const double s = std::sin(2.0 * theta);
  Mat5 jacobian = Mat5::Zero();
  jacobian.row(0).head<2>() << 0.5, 0.5;
  jacobian.row(1) << 0.5 * c, -0.5 * c, 0.0, 0.0, -2.0 * ovality * s;
  jacobian.row(2) << 0.5 * s, -0.5 * s, 0.0, 0.0, 2.0 * ovality * c;
  jacobian(3, 2) = jacobian(4, 3) = 1.0;
  return jacobian;
}

}  // namespace

std::optional<ShapePoseCovariance> moment_across_circle(const CanonicalFit& ellipse,
                                                        const ShapePoseCovariance& linear) {
  // Of a normal law's density, a third of a deviation apart, as far as five: where the axes change
  // places within a step, these hold the share on either side to a few hundredths of the mass.
  constexpr int kSteps = 15;
  constexpr double kStep = 1.0 / 3.0;
  // Deviations: the direction's variance is a hundredth off.
  constexpr double kFar = 10.0;
  const double a = ellipse.shape.values[0];
  const double b = ellipse.shape.values[1];
  const double theta = ellipse.world_T_curve.theta;
  const double ovality = 0.5 * (a - b);
  if (!(ovality > 0.0) || !linear.allFinite()) {
    return std::nullopt;
  }
  const Mat5 to_oval = by_ellipse(ovality, theta);
  const Mat5 covariance = to_oval * linear * to_oval.transpose();
  const SymmetricEigen axes = symmetric_eigen(covariance.block<2, 2>(1, 1));
  const Eigen::Vector2d variances = axes.values;
  const Eigen::Matrix2d directions = axes.vectors;
  if (!(variances[0] > 0.0) || ovality * ovality > kFar * kFar * variances[1]) {
    return std::nullopt;
  }
  const Eigen::Matrix2d root = directions * variances.cwiseSqrt().asDiagonal();
  // How mean radius and centre follow the ovality, and what is left of them.
  Eigen::Matrix<double, 3, 2> with_oval;
  with_oval << covariance.row(0).segment<2>(1), covariance.block<2, 2>(3, 1);
  const Eigen::Matrix<double, 3, 2> follow =
      with_oval * directions * variances.cwiseInverse().asDiagonal() * directions.transpose();
  Eigen::Matrix3d left;
  left << covariance(0, 0), covariance.row(0).tail<2>(), covariance.col(0).tail<2>(),
      covariance.bottomRightCorner<2, 2>();
  left -= follow * with_oval.transpose();
  Eigen::Matrix<double, 5, 3> by_left = Eigen::Matrix<double, 5, 3>::Zero();
  by_left(0, 0) = by_left(1, 0) = by_left(2, 1) = by_left(3, 2) = 1.0;

  const Eigen::Vector2d oval =
      ovality * Eigen::Vector2d(std::cos(2.0 * theta), std::sin(2.0 * theta));
  Mat5 moment = Mat5::Zero();
  double sum = 0.0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Eigen::Vector2d deviations = kStep * Eigen::Vector2d(i, j);
      const double weight = std::exp(-0.5 * deviations.squaredNorm());
      const Eigen::Vector2d by = root * deviations;
      const Eigen::Vector3d others = follow * by;
      const Eigen::Vector2d there = oval + by;
      const double more = there.norm() - ovality;
      const double turn =
          std::remainder(0.5 * std::atan2(there.y(), there.x()) - theta, std::numbers::pi);
      Vec5 away;
      away << others[0] + more, others[0] - more, others[1], others[2], turn;
      moment += weight * (away * away.transpose());
      sum += weight;
    }
  }
  return moment / sum + by_left * left * by_left.transpose();
}

}  // namespace palpate
