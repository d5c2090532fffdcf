// A plane curve with cubic polynomials as its coordinates, (53).
#pragma once

#include <Eigen/Core>

#include "core/curves/plane_curve.h"

namespace palpate {

/// x(t) = sum c(0, k) t^k, y(t) = sum c(1, k) t^k, k = 0 ... 3. [m]
struct PolynomialCurve2 {
  using Coefficients = Eigen::Matrix<double, 2, 4>;
  Coefficients coefficients = Coefficients::Zero();

  Vec2 position(double t) const {
    const Coefficients& c = coefficients;
    return c.col(0) + t * (c.col(1) + t * (c.col(2) + t * c.col(3)));
  }

  CurveDerivatives derivatives(double t) const {
    const Coefficients& c = coefficients;
    return {position(t), c.col(1) + t * (2.0 * c.col(2) + 3.0 * t * c.col(3)),
            2.0 * c.col(2) + 6.0 * t * c.col(3), 6.0 * c.col(3)};
  }

  /// The same curve over u = t - t0.
  PolynomialCurve2 shifted(double t0) const {
    const Coefficients& c = coefficients;
    PolynomialCurve2 result;
    result.coefficients << position(t0), c.col(1) + t0 * (2.0 * c.col(2) + 3.0 * t0 * c.col(3)),
        c.col(2) + 3.0 * t0 * c.col(3), c.col(3);
    return result;
  }
};

}  // namespace palpate
