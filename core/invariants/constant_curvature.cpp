#include "core/invariants/constant_curvature.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// Standard deviation of exact data, of kappa and kappa_s in units of the points' own scale.
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();

/// (kappa, kappa_s) of a point travelled so that its patch turns left on the whole, and the inverse
/// of their covariance; in lengths of 1 / scale.
struct LeftTurning {
  Eigen::Vector2d z;
  Eigen::Matrix2d weight;
};

LeftTurning left_turning(std::span<const MeasuredGeometry> points, const MeasuredGeometry& point,
                         double scale) {
  double sum = 0.0;
  for (const MeasuredGeometry& other : points) {
    sum += other.patch == point.patch ? other.kappa : 0.0;
  }
  const double sign = std::copysign(1.0, sum);
  const MeasuredGeometry p = in_units_of(point, 1.0 / scale);
  Eigen::Matrix2d covariance = p.covariance.bottomRightCorner<2, 2>();
  covariance.diagonal().array() += kRounding * kRounding;
  covariance(0, 1) *= sign;
  covariance(1, 0) *= sign;
  return {{sign * p.kappa, p.kappa_s}, covariance.inverse()};
}

}  // namespace

ConstantCurvature fit_constant_curvature(std::span<const MeasuredGeometry> points) {
  ConstantCurvature fit;
  if (points.empty()) {
    return fit;
  }
  for (const MeasuredGeometry& point : points) {
    if (!is_finite(point)) {
      fit.status = InvariantStatus::NotFinite;
      return fit;
    }
  }
  const int count = static_cast<int>(points.size());
  fit.status = InvariantStatus::Ok;
  fit.circle_dof = 2 * count - 1;
  fit.line_dof = 2 * count;
  const double scale = curvature_scale(points);
  if (scale == 0.0) {
    return fit;  // exactly straight: both chi-squares are zero
  }
  double weight_sum = 0.0;
  double weighted = 0.0;
  for (const MeasuredGeometry& point : points) {
    const auto [z, weight] = left_turning(points, point, scale);
    weight_sum += weight(0, 0);
    weighted += weight.row(0).dot(z);
    fit.line_chi2 += z.dot(weight * z);
  }
  fit.kappa = weighted / weight_sum;
  fit.variance = scale * scale / weight_sum;
  for (const MeasuredGeometry& point : points) {
    const auto [z, weight] = left_turning(points, point, scale);
    const Eigen::Vector2d residual(z[0] - fit.kappa, z[1]);
    fit.circle_chi2 += residual.dot(weight * residual);
  }
  fit.kappa = std::abs(fit.kappa) * scale;
  if (!std::isfinite(fit.kappa) || !std::isfinite(fit.variance) || !std::isfinite(fit.line_chi2)) {
    fit = {.status = InvariantStatus::NotFinite};
  }
  return fit;
}

}  // namespace palpate
