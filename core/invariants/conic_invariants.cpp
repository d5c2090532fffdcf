#include "core/invariants/conic_invariants.h"

#include <array>
#include <cmath>

#include "core/invariants/jet_propagation.h"

namespace palpate {

ConicInvariants conic_invariants(const MeasuredGeometry& point1, const MeasuredGeometry& point2) {
  ConicInvariants result;
  const auto failed = [&](InvariantStatus status) {
    result.status = status;
    return result;
  };
  if (!is_finite(point1) || !is_finite(point2)) {
    return failed(InvariantStatus::NotFinite);
  }
  if (point1.kappa == 0.0 || point2.kappa == 0.0) {
    return failed(InvariantStatus::ZeroCurvature);
  }
  if (point1.patch == point2.patch && std::signbit(point1.kappa) != std::signbit(point2.kappa)) {
    return failed(InvariantStatus::SignChange);
  }
  if (std::abs(point1.kappa) == std::abs(point2.kappa)) {
    return failed(InvariantStatus::PointsTooAlike);
  }
  const Eigen::Vector4d inputs(point1.kappa, point1.kappa_s, point2.kappa, point2.kappa_s);
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  covariance.topLeftCorner<2, 2>() = point1.covariance.bottomRightCorner<2, 2>();
  covariance.bottomRightCorner<2, 2>() = point2.covariance.bottomRightCorner<2, 2>();
  const auto propagated = propagate<2, 4>(inputs, [](const auto& x) {
    auto invariants = std::array{x[0], x[0]};
    conic_pair(x[0], x[1], x[2], x[3], invariants[0], invariants[1]);
    return invariants;
  });
  const Eigen::Matrix2d propagated_covariance = propagated.covariance(covariance);
  if (!propagated.value.allFinite() || !propagated_covariance.allFinite()) {
    return failed(InvariantStatus::NotFinite);
  }
  result.status = InvariantStatus::Ok;
  result.ic1 = propagated.value[0];
  result.ic2 = propagated.value[1];
  result.covariance = propagated_covariance;
  return result;
}

}  // namespace palpate
