// How shape parameters scale with the unit of length.
#pragma once

#include <Eigen/Core>

#include "core/curves/curve_class.h"

namespace palpate {

/// Power of length in the unit of each shape parameter, in the order of parameter_letters(class).
inline Eigen::Vector3d length_powers(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return {-2.0, 0.0, 0.0};
    case CurveClass::SemiCubicalParabola:
      return {-0.5, 0.0, 0.0};
    case CurveClass::CubicSpline:
      return {-0.5, 0.0, 0.5};
    default:
      return {1.0, 1.0, 0.0};
  }
}

/// Power of length in the unit of the curve's parameter t.
inline double length_power_of_t(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Line:
    case CurveClass::CubicalParabola:
      return 1.0;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return 0.5;
    default:
      return 0.0;
  }
}

}  // namespace palpate
