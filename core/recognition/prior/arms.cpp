#include "core/recognition/prior/arms.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/recognition/prior/bend_laws.h"
#include "core/recognition/prior/ellipse_places.h"
#include "core/recognition/prior/size_law.h"

namespace palpate {
namespace {

/// The part is touched where its arm ends. Of a part of given size curvature there falls with the
/// power n of a coordinate; as in bend_laws.h, Student's law has 2 n degrees of freedom. Half of
/// the places lie beyond those at which kSlope and the others have a part end, half of the slopes
/// beyond 45 degrees.
///
/// Scales with which half of the law lies beyond 1: of two degrees of freedom, and of four.
constexpr double kHalfOfTwo = std::numbers::sqrt3;
constexpr double kHalfOfFour = 2.7001;
/// Slope at the bend: curvature as its power -2.
constexpr StudentLaw kSlopeOfBend{4, kHalfOfFour};
/// t of the parabola, and the same slope against the tangent of an ellipse's tip: the size as t^2,
/// curvature as t^-3 of p, -1 of the size.
constexpr StudentLaw kParabola{2, 3.0 * kHalfOfTwo};
/// t / L of the cubical parabola: the size as its power 3, curvature -5 of L, -2 of the size.
constexpr StudentLaw kCubical{4, 1.0 * kHalfOfFour};

/// log of a length that a part has over the length of its coordinates, and the derivatives by
/// these.
struct Extent {
  double log = 0.0;
  TouchedVector gradient = TouchedVector::Zero();
};

/// The slope against the tangent of an ellipse's tip.
double slope_from_tip(double direction) { return std::cos(direction) / std::sin(direction); }

/// Half the diagonal of the box of a part that ends at the place, or where it does without arms if
/// the place is nearer: t^2 + 9 of the parabola and so on.
Extent extent_of(CurveClass curve_class, const TouchedVector& z) {
  assert(has_arms(curve_class));
  Extent extent;
  const double slope = z[1];
  const double place = z[place_coordinate(curve_class)];
  // The box of a parabola: q / 2 p, 2 sqrt(q) p.
  const auto of_parabola = [](double t) { return 9.0 + t * t; };
  const auto log_of_parabola = [](double q) { return 0.5 * std::log(q * (q + 16.0) / 16.0); };
  const auto derivative_of_parabola = [](double t, double q) { return t / q + t / (q + 16.0); };
  switch (curve_class) {
    case CurveClass::Parabola: {
      const double q = of_parabola(place);
      extent.log = log_of_parabola(q);
      extent.gradient[1] = derivative_of_parabola(place, q);
      break;
    }
    case CurveClass::Ellipse: {
      const double t = slope_from_tip(place);
      const double q = of_parabola(t);
      extent.log = log_of_parabola(q);
      extent.gradient[2] = -(1.0 + t * t) * derivative_of_parabola(t, q);
      break;
    }
    case CurveClass::Hyperbola:  // c, half the distance of the foci, wherever it is touched
      extent.log = log_diagonal_over_p(z[1]);
      extent.gradient[1] = log_diagonal_derivative(z[1]);
      break;
    default: {                               // cubical parabola
      const double q = 1.0 + place * place;  // the box, of half: sqrt(q) by q^(3/2), sheared
      const double sum = 1.0 + q * q + slope * slope;
      extent.log = 0.5 * std::log(q * sum);
      extent.gradient[1] = slope / sum;
      extent.gradient[2] = place * (1.0 / q + 2.0 * q / sum);
      break;
    }
  }
  return extent;
}

/// log of the height of a law over that of the prior's centre.
double log_of_heights(const StudentLaw& law, const StudentLaw& at_centre) {
  return std::log(at_centre.width() / law.width());
}

/// A hyperbola's place y / b over w = e y / p.
double wedge_place_over_w(double m) { return std::sqrt(m / (1.0 + m)); }

}  // namespace

bool has_arms(CurveClass curve_class) {
  return curve_class == CurveClass::Ellipse || curve_class == CurveClass::Parabola ||
         curve_class == CurveClass::Hyperbola || curve_class == CurveClass::CubicalParabola;
}

double log_size_of_arms(CurveClass curve_class, const TouchedVector& z) {
  return z[0] + extent_of(curve_class, z).log - kLogSize;
}

double log_prior_of_arms(CurveClass curve_class, const TouchedVector& z) {
  if (curve_class == CurveClass::Hyperbola && !(z[1] > 0.0)) {
    return -std::numeric_limits<double>::infinity();  // next to the parabola it is endless
  }
  const double of_size = log_of_size(log_size_of_arms(curve_class, z));
  switch (curve_class) {
    case CurveClass::Parabola:
      return of_size + log_of_heights(kParabola, kSlope) + kParabola.log(z[1]);
    case CurveClass::Ellipse: {
      // The density of the slope times its rate by direction, 1 / sin^2. That of m is as e^2 = 1 -
      // m: none of a circle, which has no tip.
      const double sine2 = std::pow(std::sin(z[2]), 2);
      const double tail = sine2 + (1.0 - sine2) / (kParabola.scale * kParabola.scale);
      return of_size + std::log(width_of_direction(z[1]) / kParabola.width()) -
             1.5 * std::log(tail) + 0.5 * std::log(sine2) + std::log(2.0 * (1.0 - z[1]));
    }
    case CurveClass::Hyperbola: {
      // b^2 / c^2 = m / (1 + m) is uniform, c half the distance of the foci: straight at both ends,
      // where curvature in units of c is as its root and as that of what it lacks of 1. The density
      // of m, 1 / (1 + m)^2, over the height of Cauchy's law above 0, 1 / (0.75 pi), times the
      // place's rate by w.
      const double m = z[1];
      const double rate = wedge_place_over_w(m);
      return of_size + std::log(0.75 * kPi * rate) - 2.0 * std::log1p(m) + kSlope.log(rate * z[2]);
    }
    default:
      return of_size + log_of_heights(kSlopeOfBend, kSlope) + kSlopeOfBend.log(z[1]) +
             log_of_heights(kCubical, kPlaceFromInflection) + kCubical.log(z[2]);
  }
}

TouchedVector gradient_of_arms(CurveClass curve_class, const TouchedVector& z) {
  const Extent extent = extent_of(curve_class, z);
  const double of_size = log_of_size_derivative(z[0] + extent.log - kLogSize);
  TouchedVector gradient = of_size * extent.gradient;
  gradient[0] = of_size;
  switch (curve_class) {
    case CurveClass::Parabola:
      gradient[1] += kParabola.derivative(z[1]);
      break;
    case CurveClass::Ellipse: {
      const double sine = std::sin(z[2]);
      const double cosine = std::cos(z[2]);
      const double inverse_square = 1.0 / (kParabola.scale * kParabola.scale);
      const double tail = sine * sine + cosine * cosine * inverse_square;
      gradient[1] += log_quarter_perimeter_derivative(z[1]) + 0.5 / z[1] - 1.0 / (1.0 - z[1]);
      gradient[2] += cosine / sine - 3.0 * sine * cosine * (1.0 - inverse_square) / tail;
      break;
    }
    case CurveClass::Hyperbola: {
      const double m = z[1];
      const double by_w = wedge_place_over_w(m);
      const double of_place = kSlope.derivative(by_w * z[2]);
      gradient[1] += 0.5 / (m * (1.0 + m)) * (1.0 + of_place * z[2] * by_w) - 2.0 / (1.0 + m);
      gradient[2] += of_place * by_w;
      break;
    }
    default:
      gradient[1] += kSlopeOfBend.derivative(z[1]);
      gradient[2] += kCubical.derivative(z[2]);
      break;
  }
  return gradient;
}

double width_on_arms(CurveClass curve_class, int k) {
  switch (curve_class) {
    case CurveClass::Parabola:
    case CurveClass::Ellipse:
      return kParabola.width();
    case CurveClass::Hyperbola:
      return kSlope.width();
    default:
      return (k == 1 ? kSlopeOfBend : kCubical).width();
  }
}

}  // namespace palpate
