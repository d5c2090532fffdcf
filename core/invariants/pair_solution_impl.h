// The solution for a pair of points, common to the cubical and the semi-cubical parabola. Included
// only by their source files.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include "core/invariants/canonical_point.h"
#include "core/invariants/jet_propagation.h"
#include "core/invariants/pair_solution.h"

namespace palpate::detail {

/// The coefficients of the quadratic are sums of about ten products. Below this fraction of their
/// terms they consist of rounding.
inline constexpr double kCoefficientRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// A discriminant this close to zero counts as a double root; its rounding is that of the
/// coefficients.
inline constexpr double kDiscriminantRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Variance of a quantity that the data do not determine.
inline constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// `Family` has
///   quadratic(k1, ks1, k2, ks2, rotation),
///   signed_invariant(CanonicalPoint), which is Icp1 or Iscp1,
///   parameters(CanonicalPoint), an array of 2, and
///   accept(solution, unit), which converts angle and parameters to the convention and the units
///   of the class; false if they lie outside the class.
template <typename Family>
PairSolutions solve_pair(const MeasuredGeometry& measured1, const MeasuredGeometry& measured2) {
  PairSolutions result;
  if (!is_finite(measured1) || !is_finite(measured2)) {
    result.status = InvariantStatus::NotFinite;
    return result;
  }
  const std::array both{measured1, measured2};
  const double scale = curvature_scale(both);
  if (scale == 0.0) {
    result.status = InvariantStatus::ZeroCurvature;
    return result;
  }
  const double unit = 1.0 / scale;
  const MeasuredGeometry p1 = in_units_of(measured1, unit);
  const MeasuredGeometry p2 = in_units_of(measured2, unit);
  const double rotation = p2.tangent_angle - p1.tangent_angle;

  const auto quadratic = Family::quadratic(p1.kappa, p1.kappa_s, p2.kappa, p2.kappa_s, rotation);
  const double size = std::abs(quadratic.q2) + std::abs(quadratic.q1) + std::abs(quadratic.q0);
  const double terms =
      (std::abs(p1.kappa_s) + p1.kappa * p1.kappa) * (std::abs(p2.kappa_s) + p2.kappa * p2.kappa);
  if (!(size > kCoefficientRounding * terms)) {
    result.status = InvariantStatus::PointsTooAlike;
    return result;
  }
  result.relative_discriminant = relative_discriminant(quadratic);
  result.nearest_angle = nearest_angle(quadratic);
  if (result.relative_discriminant < -kDiscriminantRounding) {
    result.status = InvariantStatus::NoRealRoot;
    return result;
  }

  Eigen::Matrix<double, 6, 1> inputs;
  inputs << p1.tangent_angle, p1.kappa, p1.kappa_s, p2.tangent_angle, p2.kappa, p2.kappa_s;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance.topLeftCorner<3, 3>() = p1.covariance;
  covariance.bottomRightCorner<3, 3>() = p2.covariance;
  const bool double_root = result.relative_discriminant <= kDiscriminantRounding;
  const auto evaluate = [&](const auto& x, const auto& angle) {
    using std::abs;
    const auto point1 = canonical_point(angle, x[1], x[2]);
    const decltype(x[0] + x[0]) angle2 = angle + x[3] - x[0];
    const auto point2 = canonical_point(angle2, x[4], x[5]);
    const auto parameters = Family::parameters(point1);
    const auto invariant1 = Family::signed_invariant(point1);
    const auto invariant2 = Family::signed_invariant(point2);
    return std::array{angle, parameters[0], parameters[1],
                      (invariant1 - invariant2) / (abs(invariant1) + abs(invariant2))};
  };
  for (const double branch : {1.0, -1.0}) {
    PairSolution solution;
    Eigen::Vector4d value;
    Eigen::Matrix4d value_covariance = Eigen::Matrix4d::Zero();
    if (double_root) {
      const auto outputs = evaluate(inputs, result.nearest_angle);
      value << outputs[0], outputs[1], outputs[2], outputs[3];
    } else {
      const auto propagated = propagate<4, 6>(inputs, [&](const auto& x) {
        return evaluate(
            x, canonical_angle(Family::quadratic(x[1], x[2], x[4], x[5], x[3] - x[0]), branch));
      });
      value = propagated.value;
      value_covariance = propagated.covariance(covariance);
    }
    if (double_root || !value_covariance.allFinite()) {  // first order is not enough
      value_covariance = Eigen::Vector4d::Constant(kUnknown).asDiagonal();
    }
    solution.angle = value[0];
    solution.parameters = value.segment<2>(1);
    solution.covariance = value_covariance.block<2, 2>(1, 1);
    solution.mismatch = value[3];
    solution.mismatch_variance = value_covariance(3, 3);
    if (value.allFinite() && Family::accept(solution, unit)) {
      if (solution.covariance.hasNaN()) {  // 0 times a power of the unit that overflowed
        solution.covariance = Eigen::Vector2d::Constant(kUnknown).asDiagonal();
      }
      result.solutions[static_cast<std::size_t>(result.count++)] = solution;
    }
    if (double_root) {
      break;
    }
  }
  if (result.count == 2 &&
      std::abs(result.solutions[1].mismatch) < std::abs(result.solutions[0].mismatch)) {
    std::swap(result.solutions[0], result.solutions[1]);
  }
  result.status = result.count > 0 ? InvariantStatus::Ok : InvariantStatus::NotThisClass;
  return result;
}

}  // namespace palpate::detail
