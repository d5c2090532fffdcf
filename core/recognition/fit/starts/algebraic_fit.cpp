#include "core/recognition/fit/starts/algebraic_fit.h"

#include <Eigen/Core>

#include "core/numerics/matrices/symmetric_eigen.h"

namespace palpate {

ConicCoefficients algebraic_conic(std::span<const FitPoint> points) {
  Monomials mean = Monomials::Zero();
  double weight_sum = 0.0;
  for (const FitPoint& point : points) {
    const double w = point.inverse_sigma * point.inverse_sigma;
    mean += w * monomials(point.position);
    weight_sum += w;
  }
  mean /= weight_sum;
  using Matrix5 = Eigen::Matrix<double, 5, 5>;
  Matrix5 scatter = Matrix5::Zero();
  Matrix5 gradients = Matrix5::Zero();
  for (const FitPoint& point : points) {
    const double w = point.inverse_sigma * point.inverse_sigma / weight_sum;
    const Vec2& p = point.position;
    const Eigen::Matrix<double, 5, 1> m = (monomials(p) - mean).head<5>();
    scatter.noalias() += w * m * m.transpose();
    Eigen::Matrix<double, 5, 2> d;
    d << 2.0 * p.x(), 0.0, p.y(), p.x(), 0.0, 2.0 * p.y(), 1.0, 0.0, 0.0, 1.0;
    gradients.noalias() += w * d * d.transpose();
  }
  // Points on a line leave one gradient direction empty; a rounding-level ridge keeps the
  // eigenproblem defined.
  constexpr double kRidge = 1e-14;
  gradients.diagonal().array() += kRidge * gradients.trace();
  ConicCoefficients q;
  q.head<5>() = least_generalised_eigenvector(scatter, gradients);
  q[5] = -q.head<5>().dot(mean.head<5>());
  return q.normalized();
}

ConicCoefficients algebraic_circle(std::span<const FitPoint> points) {
  // Taubin's circle: z = x^2 + y^2 regressed with gradient weights (3 x 3 eigenproblem).
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double weight_sum = 0.0;
  const auto features = [](const Vec2& p) {
    return Eigen::Vector3d(p.squaredNorm(), p.x(), p.y());
  };
  for (const FitPoint& point : points) {
    const double w = point.inverse_sigma * point.inverse_sigma;
    mean += w * features(point.position);
    weight_sum += w;
  }
  mean /= weight_sum;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d gradients = Eigen::Matrix3d::Zero();
  for (const FitPoint& point : points) {
    const double w = point.inverse_sigma * point.inverse_sigma / weight_sum;
    const Vec2& p = point.position;
    const Eigen::Vector3d m = features(p) - mean;
    scatter.noalias() += w * m * m.transpose();
    Eigen::Matrix<double, 3, 2> d;
    d << 2.0 * p.x(), 2.0 * p.y(), 1.0, 0.0, 0.0, 1.0;
    gradients.noalias() += w * d * d.transpose();
  }
  const Eigen::Vector3d v = least_generalised_eigenvector(scatter, gradients);
  ConicCoefficients q;
  q << v[0], 0.0, v[0], v[1], v[2], -v.dot(mean);
  return q.normalized();
}

ConicCoefficients algebraic_line(std::span<const FitPoint> points) {
  Vec2 mean = Vec2::Zero();
  double weight_sum = 0.0;
  for (const FitPoint& point : points) {
    const double w = point.inverse_sigma * point.inverse_sigma;
    mean += w * point.position;
    weight_sum += w;
  }
  mean /= weight_sum;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const FitPoint& point : points) {
    const double w = point.inverse_sigma * point.inverse_sigma / weight_sum;
    scatter.noalias() += w * (point.position - mean) * (point.position - mean).transpose();
  }
  const Vec2 normal = symmetric_eigen(scatter).vectors.col(0);
  ConicCoefficients q;
  q << 0.0, 0.0, 0.0, normal.x(), normal.y(), -normal.dot(mean);
  return q.normalized();
}

}  // namespace palpate
