#include "core/recognition/prior/touched_coordinates.h"

#include <cmath>

#include "core/recognition/prior/arc_coordinates.h"

namespace palpate {

double parameter_scale(CurveClass curve_class, int index, double scale) {
  const bool of_t = index < 0;
  switch (curve_class) {
    case CurveClass::Line:
      return scale;
    case CurveClass::CubicalParabola:
      return of_t ? scale : index == 0 ? 1.0 / (scale * scale) : 1.0;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return of_t || index == 2 ? std::sqrt(scale) : index == 0 ? 1.0 / std::sqrt(scale) : 1.0;
    default:
      return of_t ? 1.0 : scale;
  }
}

TouchedShape normalised_shape(CurveClass curve_class, const TouchedShape& shape, double scale) {
  TouchedShape normalised;
  for (int k = 0; k < 3; ++k) {
    normalised.values[k] = shape.values[k] / parameter_scale(curve_class, k, scale);
  }
  normalised.t = shape.t / parameter_scale(curve_class, -1, scale);
  return normalised;
}

int shape_coordinates(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Circle:
      return 1;
    case CurveClass::Parabola:
      return 2;
    case CurveClass::Ellipse:
    case CurveClass::Hyperbola:
    case CurveClass::CubicalParabola:
    case CurveClass::SemiCubicalParabola:
      return 3;
    case CurveClass::CubicSpline:
      return 4;
    default:
      return 0;
  }
}

TouchedVector coordinates_of(Chart chart, const TouchedShape& shape) {
  TouchedVector z = TouchedVector::Zero();
  const double a = shape.values[0];
  const double b = shape.values[1];
  const double t = shape.t;
  if (chart.as_arc) {
    z.head<4>() = arc_coordinates_of(shape);
    return z;
  }
  switch (chart.curve_class) {
    case CurveClass::Circle:
      z[0] = std::log(a);
      break;
    case CurveClass::Ellipse:
      z.head<3>() << std::log(b * b / a), b * b / (a * a),
          std::atan2(b * std::cos(t), -a * std::sin(t));
      break;
    case CurveClass::Hyperbola:
      z.head<3>() << std::log(b * b / a), b * b / (a * a), std::hypot(a, b) / b * std::sinh(t);
      break;
    case CurveClass::Parabola:
      z.head<2>() << std::log(2.0 * a), t;
      break;
    case CurveClass::CubicalParabola: {
      const double root = std::sqrt(std::abs(a));
      z.head<3>() << -std::log(root), b, t * root;
      break;
    }
    case CurveClass::SemiCubicalParabola:
      z.head<3>() << -2.0 * std::log(a), b, a * t;
      break;
    case CurveClass::CubicSpline:
      z.head<4>() << -2.0 * std::log(a), b, a * t, a * shape.values[2];
      break;
    default:
      break;
  }
  return z;
}

std::optional<TouchedShape> shape_at(Chart chart, const TouchedVector& z,
                                     const TouchedShape& like) {
  if (chart.as_arc) {
    return spline_at(z.head<4>());
  }
  TouchedShape shape;
  shape.t = like.t;  // line and circle: all places are alike
  switch (chart.curve_class) {
    case CurveClass::Circle:
      shape.values[0] = std::exp(z[0]);
      break;
    case CurveClass::Ellipse: {
      if (!(z[1] > 0.0 && z[1] <= 1.0)) {
        return std::nullopt;
      }
      const double p = std::exp(z[0]);
      const double a = p / z[1];
      const double b = p / std::sqrt(z[1]);
      shape = {{a, b, 0.0}, std::atan2(-std::cos(z[2]) / a, std::sin(z[2]) / b)};
      break;
    }
    case CurveClass::Hyperbola: {
      if (!(z[1] > 0.0)) {
        return std::nullopt;
      }
      const double p = std::exp(z[0]);
      const double a = p / z[1];
      const double b = p / std::sqrt(z[1]);
      shape = {{a, b, 0.0}, std::asinh(b / std::hypot(a, b) * z[2])};
      break;
    }
    case CurveClass::Parabola:
      shape = {{0.5 * std::exp(z[0]), 0.0, 0.0}, z[1]};
      break;
    case CurveClass::CubicalParabola: {
      const double length = std::exp(z[0]);
      shape = {{std::copysign(1.0 / (length * length), like.values[0]), z[1], 0.0}, z[2] * length};
      break;
    }
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline: {
      const double a = std::exp(-0.5 * z[0]);
      const double c = chart.curve_class == CurveClass::CubicSpline ? z[3] / a : 0.0;
      shape = {{a, z[1], c}, z[2] / a};
      break;
    }
    default:
      break;
  }
  return shape.values.allFinite() && std::isfinite(shape.t) ? std::optional(shape) : std::nullopt;
}

int place_coordinate(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Line:
    case CurveClass::Circle:
      return -1;
    case CurveClass::Parabola:
      return 1;
    default:
      return 2;
  }
}

}  // namespace palpate
