#include "core/recognition/fit/inverse_information.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/numerics/matrices/symmetric_eigen.h"

namespace palpate {

ShapePoseCovariance untold_covariance(Eigen::Index n) {
  ShapePoseCovariance untold = ShapePoseCovariance::Zero(n, n);
  untold.diagonal().setConstant(std::numeric_limits<double>::infinity());
  return untold;
}

namespace {

InverseInformation inverse_of_rank(const ShapePoseCovariance& information, int rank) {
  const Eigen::Index n = information.rows();
  if (!information.allFinite()) {  // units in which a square is beyond a double: nothing is told
    return {untold_covariance(n), std::numeric_limits<double>::infinity()};
  }
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    scale[i] = information(i, i) > 0.0 ? 1.0 / std::sqrt(information(i, i)) : 0.0;
  }
  const ShapePoseCovariance scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  ShapePoseCovariance inverse = ShapePoseCovariance::Zero(n, n);
  InverseInformation result;
  for (Eigen::Index i = 0; i < n; ++i) {
    result.log_determinant -= scale[i] > 0.0 ? 2.0 * std::log(scale[i]) : 0.0;
  }
  result.weakest = eigen.values[n - rank];
  for (Eigen::Index k = n - rank; k < n; ++k) {
    // Rounding leaves the weakest direction no smaller than this; beyond it the variance is as good
    // as infinite, and says so by its size.
    const double least = std::numeric_limits<double>::epsilon();
    const double value = std::max(eigen.values[k], least);
    inverse += eigen.vectors.col(k) * eigen.vectors.col(k).transpose() / value;
    result.log_determinant += std::log(value);
  }
  result.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  return result;
}

}  // namespace

InverseInformation inverse_information(const ShapePoseCovariance& information,
                                       CurveClass curve_class, double theta) {
  const int rank = degrees_of_freedom(curve_class);
  if (curve_class != CurveClass::Line) return inverse_of_rank(information, rank);
  // It is free along itself, askew to x and y. Inverted there, the place along it would get what
  // the scales of x and y make of it: kilometres where it lies along one of them.
  Eigen::Matrix3d world_R_line = Eigen::Matrix3d::Identity();
  world_R_line.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(theta).toRotationMatrix();
  ShapePoseCovariance on_line = world_R_line.transpose() * information * world_R_line;
  on_line.row(0).setZero();  // rounding alone
  on_line.col(0).setZero();
  InverseInformation inverse = inverse_of_rank(on_line, rank);
  if (inverse.covariance.allFinite()) {
    inverse.covariance = world_R_line * inverse.covariance * world_R_line.transpose();
  }
  return inverse;
}

Eigen::Matrix<double, 6, 6> covariance_from_rows(const std::vector<ResidualRow>& rows) {
  assert(rows.size() >= 6);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6>;
  Rows scaled(static_cast<Eigen::Index>(rows.size()), 6);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    scaled.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  }
  const Eigen::Matrix<double, 6, 1> scale = scaled.colwise().norm().cwiseInverse().transpose();
  scaled *= scale.asDiagonal();
  const Eigen::ColPivHouseholderQR<Rows> qr(scaled);
  const Eigen::Matrix<double, 6, 6> root = qr.matrixR().topRows<6>();
  const Eigen::Matrix<double, 6, 6> permuted =
      root.triangularView<Eigen::Upper>().solve(Eigen::Matrix<double, 6, 6>::Identity());
  const Eigen::Matrix<double, 6, 6> inverse =
      scale.asDiagonal() * (qr.colsPermutation() * permuted).eval();
  return inverse * inverse.transpose();
}

}  // namespace palpate
