// Joint error of shape and pose, in the directions that the data determine.
#pragma once

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "tests/support/scene_data.h"

namespace palpate::test {

struct JointError {
  Eigen::VectorXd error;       ///< of the determined parameters
  Eigen::MatrixXd covariance;  ///< of the same, as published
};

/// Error of [shape; x; y; theta], without theta for a circle; for a line only its distance and its
/// direction.
inline JointError joint_error(const Hypothesis& found, const Scene& scene) {
  JointError joint{error_of(found, scene), found.covariance};
  if (scene.curve_class == CurveClass::Line) {
    Eigen::Matrix<double, 2, 3> determined = Eigen::Matrix<double, 2, 3>::Zero();
    determined.topLeftCorner<1, 2>() = scene.world_T_curve.rotate(Vec2(0.0, 1.0)).transpose();
    determined(1, 2) = 1.0;
    joint.error[2] = std::remainder(joint.error[2], kPi);
    joint.error = (determined * joint.error).eval();
    joint.covariance = (determined * joint.covariance * determined.transpose()).eval();
  } else if (scene.curve_class == CurveClass::Circle) {
    joint.error.conservativeResize(3);
    joint.covariance.conservativeResize(3, 3);
  }
  return joint;
}

/// e^T C^-1 e. Scaled to a correlation matrix, so that the different units (metres, radians, roots
/// of metres) do no harm.
inline double squared_distance(const JointError& joint) {
  const Eigen::VectorXd scale = joint.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * joint.covariance * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * scale.cwiseProduct(joint.error);
  return along.cwiseAbs2().cwiseQuotient(solver.eigenvalues()).sum();
}

/// The 95 % quantile of chi-square with 1 to 6 degrees of freedom.
inline double chi_square_95(Eigen::Index dof) {
  constexpr std::array kQuantiles = {3.841459, 5.991465, 7.814728, 9.487729, 11.070498, 12.591587};
  return kQuantiles.at(static_cast<std::size_t>(dof - 1));
}

}  // namespace palpate::test
