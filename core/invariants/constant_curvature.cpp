#include "core/invariants/constant_curvature.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// Standard deviation of exact data: of kappa and kappa_s, in units of the points' own scale.
constexpr double kDataRounding = 8.0 * std::numeric_limits<double>::epsilon();

/// Chi-square of "kappa = 0, kappa_s = 0 and all tangents parallel". The common direction is a free
/// parameter, known up to pi because patches may be travelled either way.
double chi2_of_line(std::span<const MeasuredGeometry> points, double scale) {
  const double reference = points.front().tangent_angle;
  double weight_sum = 0.0;
  double weighted = 0.0;
  double chi2 = 0.0;
  for (const MeasuredGeometry& point : points) {
    const MeasuredGeometry p = in_units_of(point, 1.0 / scale);
    Eigen::Matrix3d covariance = p.covariance;
    covariance.diagonal().array() += kDataRounding * kDataRounding;
    const Eigen::Matrix3d weight = covariance.inverse();
    const double turn = p.tangent_angle - reference;
    const double half_turns = std::nearbyint(turn / kPi);
    const Eigen::Vector3d z(turn - kPi * half_turns, p.kappa, p.kappa_s);
    weight_sum += weight(0, 0);
    weighted += weight.row(0).dot(z);
    chi2 += z.dot(weight * z);
  }
  return chi2 - weighted * weighted / weight_sum;
}

/// (kappa, kappa_s) of a point, for the direction of travel in which its patch turns left on the
/// whole, and the inverse of their covariance. In lengths of 1 / scale.
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
  covariance.diagonal().array() += kDataRounding * kDataRounding;
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
  fit.line_dof = 3 * count - 1;
  const double scale = curvature_scale(points);
  if (scale == 0.0) {
    // Exactly straight pieces, which may or may not be parallel.
    fit.line_chi2 = chi2_of_line(points, 1.0);
    return fit;
  }
  double weight_sum = 0.0;
  double weighted = 0.0;
  for (const MeasuredGeometry& point : points) {
    const auto [z, weight] = left_turning(points, point, scale);
    weight_sum += weight(0, 0);
    weighted += weight.row(0).dot(z);
  }
  fit.line_chi2 = chi2_of_line(points, scale);
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
