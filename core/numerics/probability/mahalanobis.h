// How far a step is in units of a covariance.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace palpate {

/// step^T covariance^-1 step. Each component is scaled by its deviation first, because units of
/// lengths, angles and shape parameters differ by many orders of magnitude.
template <typename Step, typename Covariance>
double mahalanobis_square(const Eigen::MatrixBase<Step>& step,
                          const Eigen::MatrixBase<Covariance>& covariance) {
  const Eigen::VectorXd inverse = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const Eigen::VectorXd u = inverse.cwiseProduct(step);
  return u.dot(unit.ldlt().solve(u));
}

}  // namespace palpate
