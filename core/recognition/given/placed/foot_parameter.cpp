#include "core/recognition/given/placed/foot_parameter.h"

#include <cmath>

namespace palpate {

PlaneVector<double> parameter_at(CurveClass curve_class, double t) {
  switch (curve_class) {
    case CurveClass::Circle:
    case CurveClass::Ellipse:
      return {std::cos(t), std::sin(t)};
    case CurveClass::Hyperbola:
      return {std::sinh(t), 0.0};
    default:
      return {t, 0.0};
  }
}

double t_at(CurveClass curve_class, const PlaneVector<double>& parameter) {
  switch (curve_class) {
    case CurveClass::Circle:
    case CurveClass::Ellipse:
      return std::atan2(parameter.y, parameter.x);
    case CurveClass::Hyperbola:
      return std::asinh(parameter.x);
    default:
      return parameter.x;
  }
}

}  // namespace palpate
