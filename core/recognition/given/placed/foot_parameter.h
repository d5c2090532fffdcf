// Conversion between a curve's parameter t and the parameter used in the fit of a given class.
#pragma once

#include <optional>

#include "core/curves/curve.h"
#include "core/recognition/given/placed/placed_curve.h"

namespace palpate {

/// (cos t, sin t) for circle and ellipse, (sinh t, 0) for the hyperbola, else (t, 0).
PlaneVector<double> parameter_at(CurveClass curve_class, double t);

double t_at(CurveClass curve_class, const PlaneVector<double>& parameter);

/// The curve in double precision; nullopt if the shape is outside its class.
template <typename T>
std::optional<Curve> curve_of(const PlacedCurve<T>& placed) {
  // Of the half extent. With larger parameters a conic cannot be told from its limit, nor a circle
  // from a line: one of this radius bends by 5e-8 over a half extent, and numbers of its size are
  // 2e-9 apart.
  constexpr double kFarthest = 1e7;
  Eigen::Vector3d values;
  for (int i = 0; i < 3; ++i) {
    values[i] = to_double(placed.shape[i]);
  }
  if (!(values.cwiseAbs().maxCoeff() < kFarthest)) {
    return std::nullopt;
  }
  return make_curve(placed.curve_class, values);
}

}  // namespace palpate
