// The reference curves as measured geometry, and the error that rounding of the inputs explains.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/invariants/jet_propagation.h"
#include "core/invariants/measured_geometry.h"
#include "tests/support/reference_curves.h"

namespace palpate::test {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

inline MeasuredGeometry measured(const ReferencePoint& point) {
  return {.tangent_angle = point.tangent_angle, .kappa = point.kappa, .kappa_s = point.kappa_s};
}

inline std::vector<MeasuredGeometry> measured(const ReferenceCurve& curve) {
  std::vector<MeasuredGeometry> points;
  for (const ReferencePoint& point : curve.points) {
    points.push_back(measured(point));
  }
  return points;
}

inline std::vector<ReferenceCurve> reference_curves_of(CurveClass curve_class) {
  std::vector<ReferenceCurve> curves;
  for (const ReferenceCurve& curve : reference_curves()) {
    if (curve.curve_class == curve_class) {
      curves.push_back(curve);
    }
  }
  return curves;
}

/// Error bound of output i of a function of N inputs, each known to within one rounding, whose
/// evaluation adds at most `operations` roundings of the same effect:
/// operations * epsilon * sum_j |df_i/dx_j| |x_j|, plus as much of the value itself.
template <int M, int N>
Eigen::Matrix<double, M, 1> conditioning_bound(const Propagated<M, N>& f,
                                               const Eigen::Matrix<double, N, 1>& inputs,
                                               double operations) {
  return operations * kEpsilon * (f.jacobian.cwiseAbs() * inputs.cwiseAbs() + f.value.cwiseAbs());
}

}  // namespace palpate::test
