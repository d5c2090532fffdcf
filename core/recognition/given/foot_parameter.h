// Between the parameters that the fit of a given class walks in and a curve's own.
#pragma once

#include <optional>

#include "core/curves/curve.h"
#include "core/recognition/given/placed_curve.h"

namespace palpate {

/// On the circle and ellipse cosine and sine of t, on the hyperbola sinh t, else t.
PlaneVector<double> parameter_at(CurveClass curve_class, double t);

double t_at(CurveClass curve_class, const PlaneVector<double>& parameter);

/// nullopt where the class ends.
template <typename T>
std::optional<Curve> curve_of(const PlacedCurve<T>& placed) {
  // Beyond so many half extents a conic cannot be told from its limit, nor a circle from a line.
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
