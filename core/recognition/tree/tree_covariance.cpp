#include "core/recognition/tree/tree_covariance.h"

#include <cmath>
#include <optional>
#include <vector>

#include "core/numerics/matrices/symmetric_eigen.h"
#include "core/recognition/fit/inverse_information.h"
#include "core/recognition/tree/recognition_tree_tolerance.h"

namespace palpate {
namespace {

using ShapePose = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

std::optional<ShapePose> shape_pose_of(const TreeResult& result, CurveClass curve_class) {
  if (result.shape.curve_class != curve_class || !result.world_T_curve) {
    return std::nullopt;
  }
  const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
  ShapePose q(letters + 3);
  q.head(letters) = result.shape.values.head(letters);
  q.tail<3>() << result.world_T_curve->x, result.world_T_curve->y, result.world_T_curve->theta;
  return q;
}

/// A root R of the covariance (R R^T): principal axes of the correlation matrix, because the units
/// of the entries differ by many powers of ten.
Eigen::Matrix4d root_of(const Eigen::Matrix4d& covariance) {
  const Eigen::Vector4d deviations = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector4d inverse =
      deviations.unaryExpr([](double d) { return d > 0.0 ? 1.0 / d : 0.0; });
  const SymmetricEigen eigen =
      symmetric_eigen(inverse.asDiagonal() * covariance * inverse.asDiagonal());
  return deviations.asDiagonal() * eigen.vectors *
         eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

TreePoint moved(TreePoint point, const Eigen::Vector4d& by) {
  LocalEstimate& estimate = point.estimate;
  const Vec2 along(std::cos(estimate.tangent_angle), std::sin(estimate.tangent_angle));
  estimate.position += by[0] * left_of(along);
  estimate.tangent_angle += by[1];
  estimate.kappa += by[2];
  estimate.kappa_s += by[3];
  return point;
}

}  // namespace

ShapePoseCovariance propagated_covariance(std::span<const TreePoint> points,
                                          const TreeResult& answer,
                                          const RecognitionTreeOptions& options) {
  const CurveClass curve_class = answer.shape.curve_class;
  const auto n = static_cast<Eigen::Index>(parameter_letters(curve_class).size()) + 3;
  ShapePoseCovariance unknown = untold_covariance(n);
  if (!answer.world_T_curve) {
    return unknown;
  }
  const bool by_tolerance = options.relative_tolerance > 0.0;
  const auto solve = [&](std::span<const TreePoint> there) {
    return by_tolerance ? recognise_by_tolerance(there, options)
                        : solve_leaf(there, answer, options);
  };
  // Directions are compared modulo the symmetry of the curve.
  const int symmetry = pose_symmetry(curve_class);
  const double period = curve_class == CurveClass::Line || symmetry == 2 ? kPi : 2.0 * kPi;
  constexpr double kStep = 0.1;  // in standard deviations
  std::vector<TreePoint> there(points.begin(), points.end());
  ShapePoseCovariance covariance = ShapePoseCovariance::Zero(n, n);
  for (const std::size_t i : answer.pooled) {  // the answer does not depend on other points
    if (!points[i].estimate.covariance.allFinite()) {
      return unknown;
    }
    const Eigen::Matrix4d root = root_of(points[i].estimate.covariance);
    for (Eigen::Index k = 0; k < 4; ++k) {
      if (root.col(k).isZero(0.0)) {
        continue;
      }
      there[i] = moved(points[i], kStep * root.col(k));
      const auto plus = shape_pose_of(solve(there), curve_class);
      there[i] = moved(points[i], -kStep * root.col(k));
      const auto minus = shape_pose_of(solve(there), curve_class);
      there[i] = points[i];
      if (!plus || !minus) {
        return unknown;
      }
      ShapePose by = *plus - *minus;
      by[n - 1] = std::remainder(by[n - 1], period);
      by /= 2.0 * kStep;
      covariance.noalias() += by * by.transpose();
    }
  }
  return covariance;
}

}  // namespace palpate
