// Conversion between a curve's parameter t and the parameter used in the fit of a given class.
#pragma once

#include <cmath>
#include <limits>
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
  // The parameters of a spline beside a cubical parabola have no such end: as its x loses the
  // quadratic term q, its vertex goes away as q^-3 and c grows as q^-2. Farther away than this, the
  // rounding of a double moves places by a thousandth of a half extent.
  constexpr double kFarthestVertex = 1e-3 / std::numeric_limits<double>::epsilon();
  Eigen::Vector3d values;
  for (int i = 0; i < 3; ++i) {
    values[i] = to_double(placed.shape[i]);
  }
  const bool is_seen =
      placed.curve_class == CurveClass::CubicSpline
          ? std::hypot(to_double(placed.origin.x), to_double(placed.origin.y)) < kFarthestVertex
          : values.cwiseAbs().maxCoeff() < kFarthest;
  return is_seen ? make_curve(placed.curve_class, values) : std::nullopt;
}

}  // namespace palpate
