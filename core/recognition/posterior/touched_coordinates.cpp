#include "core/recognition/posterior/touched_coordinates.h"

#include <cmath>
#include <numbers>

#include "core/curves/pose2.h"

namespace palpate {
namespace {

/// Widths of normal laws with the height of: a Cauchy law of scale 1; a uniform law over [0, 1].
const double kCauchyWidth = std::sqrt(0.5 * kPi);
const double kUniformWidth = 1.0 / std::sqrt(2.0 * kPi);

/// What is touched of a part is between a tenth of its size (half the diagonal of its box) and all
/// of it: the size is 1 to 20 half extents, half way on the logarithm. Sizes far from that fall off
/// as their own power: the law of log(size) is a hyperbolic secant, that of the curvature 1 / size
/// a half Cauchy.
const double kLogSize = 0.5 * std::log(20.0);

/// In roots of the size, t and c of semi-cubical parabola and spline: slopes that Cauchy's law of
/// scale 1 gives a straight bend 3 / 2 a t + b and c / t.
constexpr double kPlaceScale = 1.5;
constexpr double kBendScale = 2.0;

/// A slope is the tangent of an angle whose density is half its cosine: steep ones are rare, as
/// what touches a part far out on its straight arms is. Student's law of 2 degrees of freedom.
const double kSlopeWidth = 2.0 * kUniformWidth;
double log_slope(double slope) { return -1.5 * std::log1p(slope * slope); }
double log_slope_derivative(double slope) { return -3.0 * slope / (1.0 + slope * slope); }

double log_cauchy(double x, double scale) { return -std::log1p(x * x / (scale * scale)); }
double log_cauchy_derivative(double x, double scale) { return -2.0 * x / (scale * scale + x * x); }

double log_size(CurveClass curve_class, double log_length) {
  // -log cosh without overflow.
  const double x = std::abs(log_length - log_length_over_size(curve_class) - kLogSize);
  return -(x + std::log1p(std::exp(-2.0 * x)) - std::numbers::ln2);
}
double log_size_derivative(CurveClass curve_class, double log_length) {
  return -std::tanh(log_length - log_length_over_size(curve_class) - kLogSize);
}

}  // namespace

/// The length in a class's coordinates over the size of a part that ends where its slope to the
/// axis is 3, some 70 degrees: the radius of a circle; p of an ellipse with b = 0.6 a, and of a
/// parabola, whose box is then 4.5 p x 6 p; L of a cubical parabola, (2 x 2) L, and of the others,
/// (4 x 16) L.
double log_length_over_size(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Circle:
      return std::log(1.0 / std::numbers::sqrt2);
    case CurveClass::Ellipse:
      return std::log(0.36 / 1.17);
    case CurveClass::Parabola:
    case CurveClass::Hyperbola:
      return std::log(1.0 / 3.75);
    case CurveClass::CubicalParabola:
      return std::log(1.0 / std::numbers::sqrt2);
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return std::log(1.0 / 8.25);
    default:
      return 0.0;
  }
}

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

TouchedVector coordinates_of(CurveClass curve_class, const TouchedShape& shape) {
  TouchedVector z = TouchedVector::Zero();
  const double a = shape.values[0];
  const double b = shape.values[1];
  const double t = shape.t;
  switch (curve_class) {
    case CurveClass::Circle:
      z[0] = std::log(a);
      break;
    case CurveClass::Ellipse:
      z.head<3>() << std::log(b * b / a), b * b / (a * a),
          std::atan2(b * std::cos(t), -a * std::sin(t));
      break;
    case CurveClass::Hyperbola:
      z.head<3>() << std::log(b * b / a), b * b / (a * a), a / b * std::sinh(t);
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

std::optional<TouchedShape> shape_at(CurveClass curve_class, const TouchedVector& z,
                                     const TouchedShape& like) {
  TouchedShape shape;
  shape.t = like.t;  // line and circle: all places are alike
  switch (curve_class) {
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
      shape = {{a, b, 0.0}, std::asinh(b / a * z[2])};
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
      const double c = curve_class == CurveClass::CubicSpline ? z[3] / a : 0.0;
      shape = {{a, z[1], c}, z[2] / a};
      break;
    }
    default:
      break;
  }
  return shape.values.allFinite() && std::isfinite(shape.t) ? std::optional(shape) : std::nullopt;
}

TouchedVector prior_widths(CurveClass curve_class, const TouchedVector& z) {
  TouchedVector widths = TouchedVector::Zero();
  // The secant law's height is that of Cauchy's.
  switch (curve_class) {
    case CurveClass::Circle:
      widths[0] = kCauchyWidth;
      break;
    case CurveClass::Ellipse:
      // m uniform in (-1, 0). A pose turned by half a turn is the same, so directions have half;
      // their density goes from uniform on the circle to the parabola's.
      widths.head<3>() << kCauchyWidth, kUniformWidth,
          2.0 * std::comp_ellint_2(std::sqrt(1.0 - z[1])) * kUniformWidth;
      break;
    case CurveClass::Hyperbola:
      // m by Cauchy's law about 1, scale 1: three quarters of it are positive. The place is y / p,
      // the slope against the vertex' tangent on the parabola.
      widths.head<3>() << kCauchyWidth, 0.75 * kCauchyWidth, kSlopeWidth;
      break;
    case CurveClass::Parabola:
      widths.head<2>() << kCauchyWidth, kSlopeWidth;
      break;
    case CurveClass::CubicalParabola:
      // Either sign of a; half a turn maps the curve to itself, so places have half.
      widths.head<3>() << 2.0 * kCauchyWidth, kSlopeWidth, 0.5 * kSlopeWidth;
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      widths.head<4>() << kCauchyWidth, kSlopeWidth, kPlaceScale * kCauchyWidth,
          kBendScale * kCauchyWidth;
      if (curve_class == CurveClass::SemiCubicalParabola) {
        widths[3] = 0.0;
      }
      break;
    default:
      break;
  }
  const int own = shape_coordinates(curve_class);
  widths[own] = kCauchyWidth;             // offset, in half extents
  widths[own + 1] = kPi * kUniformWidth;  // turn: any direction, either way of travel
  return widths;
}

double log_prior(CurveClass curve_class, const TouchedVector& z) {
  switch (curve_class) {
    case CurveClass::Circle:
      return log_size(curve_class, z[0]);
    case CurveClass::Ellipse: {
      const double sine = std::sin(z[2]);
      return log_size(curve_class, z[0]) + 0.5 * std::log(sine * sine + z[1] * (1.0 - sine * sine));
    }
    case CurveClass::Parabola:
      return log_size(curve_class, z[0]) + log_slope(z[1]);
    case CurveClass::Hyperbola:
      return log_size(curve_class, z[0]) + log_cauchy(z[1] - 1.0, 1.0) + log_slope(z[2]);
    case CurveClass::CubicalParabola:
      return log_size(curve_class, z[0]) + log_slope(z[1]) + log_slope(z[2]);
    case CurveClass::SemiCubicalParabola:
      return log_size(curve_class, z[0]) + log_slope(z[1]) + log_cauchy(z[2], kPlaceScale);
    case CurveClass::CubicSpline:
      return log_size(curve_class, z[0]) + log_slope(z[1]) + log_cauchy(z[2], kPlaceScale) +
             log_cauchy(z[3], kBendScale);
    default:
      return 0.0;
  }
}

TouchedVector log_prior_gradient(CurveClass curve_class, const TouchedVector& z) {
  TouchedVector gradient = TouchedVector::Zero();
  if (shape_coordinates(curve_class) > 0) {
    gradient[0] = log_size_derivative(curve_class, z[0]);
  }
  switch (curve_class) {
    case CurveClass::Ellipse: {
      const double sine = std::sin(z[2]);
      const double cosine = std::cos(z[2]);
      const double squares = sine * sine + z[1] * cosine * cosine;
      gradient[1] = 0.5 * cosine * cosine / squares;
      gradient[2] = (1.0 - z[1]) * sine * cosine / squares;
      break;
    }
    case CurveClass::Parabola:
      gradient[1] = log_slope_derivative(z[1]);
      break;
    case CurveClass::Hyperbola:
      gradient[1] = log_cauchy_derivative(z[1] - 1.0, 1.0);
      gradient[2] = log_slope_derivative(z[2]);
      break;
    case CurveClass::CubicalParabola:
      gradient[1] = log_slope_derivative(z[1]);
      gradient[2] = log_slope_derivative(z[2]);
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      gradient[1] = log_slope_derivative(z[1]);
      gradient[2] = log_cauchy_derivative(z[2], kPlaceScale);
      if (curve_class == CurveClass::CubicSpline) {
        gradient[3] = log_cauchy_derivative(z[3], kBendScale);
      }
      break;
    default:
      break;
  }
  return gradient;
}

}  // namespace palpate
