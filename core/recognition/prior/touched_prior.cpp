#include "core/recognition/prior/touched_prior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numerics/probability/log_add.h"
#include "core/recognition/prior/arc_coordinates.h"
#include "core/recognition/prior/student_law.h"

namespace palpate {
namespace {

/// Widths of normal laws with the height of: a Cauchy law of scale 1; a uniform law over [0, 1].
const double kCauchyWidth = std::sqrt(0.5 * kPi);
const double kUniformWidth = 1.0 / std::sqrt(2.0 * kPi);

/// What is touched of a part is between a tenth of its size (half the diagonal of its box) and all
/// of it: the size is 1 to 20 half extents, half way on the logarithm. Sizes far from that fall off
/// as the square of their own power: the law of log(size) is the square of a hyperbolic secant.
const double kLogSize = 0.5 * std::log(20.0);
/// Of the normal law as high: the density is 1 / 2 at the centre.
const double kSizeWidth = 2.0 * kUniformWidth;

/// Far out on its arms every class is straight, and so is what is very large. Parts end, and what
/// is touched is not much smaller than they are: the tails are such that curvature has a density
/// that falls to 0 with it at the straight line. With longer ones a straight edge would be taken
/// for an arm by odds that fall with the noise only. Where curvature falls with the power n of a
/// coordinate, that is 2 n degrees of freedom. Slopes against an axis or vertex tangent: n = 3,
/// half of them within 30 degrees.
constexpr StudentLaw kSlope{6, 2.0};
/// a t of semi-cubical parabola and spline: slope 3 / 2 a t, curvature as its power -4. One in
/// twenty lies beyond the place where the slope is 3, at which a part's size is told
/// (log_length_over_size).
constexpr StudentLaw kPlaceFromCusp{8, 2.45};
/// t / L of the cubical parabola: slope 3 (t / L)^2, curvature as the power -5. As many beyond 1.
constexpr StudentLaw kPlaceFromInflection{10, 1.4};
/// a c of the spline: curvature 2 / (a c)^2 at t = 0. Its inflections, 3 (a t)^2 = a c, have the
/// slope 3 where the scale is.
constexpr StudentLaw kBend{4, 3.0};
/// m = e^2 - 1 of hyperbolas, about 1: Cauchy's.
constexpr StudentLaw kEccentricity{1, 1.0};

/// log of half the diagonal of an ellipse's box, or of half the distance of a hyperbola's foci,
/// over p, m = b^2 / a^2, and its derivative.
double log_diagonal_over_p(double m) { return 0.5 * std::log1p(m) - std::log(m); }
double log_diagonal_derivative(double m) { return 0.5 / (1.0 + m) - 1.0 / m; }

/// log of the size of the part over its middle, sqrt(20) half extents.
double log_size(CurveClass curve_class, const TouchedVector& z) {
  const double log_over_length = curve_class == CurveClass::Ellipse
                                     ? log_diagonal_over_p(z[1])
                                     : -log_length_over_size(curve_class);
  return z[0] + log_over_length - kLogSize;
}

/// log of the density of that.
double log_of_size(double x) {
  // -2 log cosh without overflow.
  const double away = std::abs(x);
  return -2.0 * (away + std::log1p(std::exp(-2.0 * away)) - std::numbers::ln2);
}
double log_of_size_derivative(double x) { return -2.0 * std::tanh(x); }

/// A hyperbola's half as a wedge: its size over the middle, and its place y / b over w = e y / p.
double log_size_of_wedge(const TouchedVector& z) {
  return z[0] + log_diagonal_over_p(z[1]) - kLogSize;
}
double wedge_place_over_w(double m) { return std::sqrt(m / (1.0 + m)); }

/// The share of the wedges in a hyperbola's prior at z.
double share_of_wedges(const TouchedVector& z) {
  const double more =
      log_prior_of_half(HyperbolaHalf::Tip, z) - log_prior_of_half(HyperbolaHalf::Wedge, z);
  return 1.0 / (1.0 + std::exp(more));
}

/// A quarter of an ellipse's perimeter over a, right to 4e-4 (S. Ramanujan, 1914).
double quarter_perimeter_over_a(double m) {
  const double ratio = std::sqrt(m);
  const double flattening = (1.0 - ratio) / (1.0 + ratio);
  const double square = 3.0 * flattening * flattening;
  return 0.25 * kPi * (1.0 + ratio) * (1.0 + square / (10.0 + std::sqrt(4.0 - square)));
}

/// What curvature on an ellipse is the power 3 / 2 of, 1 at its tips: by the tangent's direction
/// from the major axis.
double tip_likeness(double m, double direction) {
  const double sine = std::sin(direction);
  return sine * sine + m * (1.0 - sine * sine);
}

}  // namespace

/// The length in a class's coordinates over the size of a part that ends where its slope to the
/// axis is 3, some 70 degrees: the radius of a circle; p of a parabola, whose box is then
/// 4.5 p x 6 p; L of a cubical parabola, (2 x 2) L, and of the others, (4 x 16) L.
double log_length_over_size(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Circle:
      return std::log(1.0 / std::numbers::sqrt2);
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

double expected_log_length(CurveClass curve_class, const TouchedVector& z) {
  return z[0] - log_size(curve_class, z);
}

double expected_log_length(HyperbolaHalf half, const TouchedVector& z) {
  return z[0] -
         (half == HyperbolaHalf::Tip ? log_size(CurveClass::Hyperbola, z) : log_size_of_wedge(z));
}

double log_prior_of_half(HyperbolaHalf half, const TouchedVector& z) {
  const double m = z[1];
  if (half == HyperbolaHalf::Tip) {
    return log_of_size(log_size(CurveClass::Hyperbola, z)) + kEccentricity.log(m - 1.0) +
           kSlope.log(z[2]);
  }
  if (!(m > 0.0)) {
    return -std::numeric_limits<double>::infinity();  // next to the parabola it is endless
  }
  // b^2 / c^2 = m / (1 + m) is uniform, c half the distance of the foci: straight at both ends,
  // where curvature in units of c is as its root and as that of what it lacks of 1. The density of
  // m, 1 / (1 + m)^2, over the height of Cauchy's law above 0, 1 / (0.75 pi), times the place's
  // rate by w.
  const double rate = wedge_place_over_w(m);
  return log_of_size(log_size_of_wedge(z)) + std::log(0.75 * kPi * rate) - 2.0 * std::log1p(m) +
         kSlope.log(rate * z[2]);
}

TouchedVector prior_centre(Chart chart) {
  TouchedVector centre = TouchedVector::Zero();
  if (chart.as_arc) {
    return centre;
  }
  const bool conic =
      chart.curve_class == CurveClass::Ellipse || chart.curve_class == CurveClass::Hyperbola;
  centre[1] = conic ? 1.0 : 0.0;
  if (shape_coordinates(chart.curve_class) > 0) {
    centre[0] = expected_log_length(chart.curve_class, centre);
  }
  return centre;
}

TouchedVector prior_widths(Chart chart, const TouchedVector& z) {
  const CurveClass curve_class = chart.curve_class;
  TouchedVector widths = TouchedVector::Zero();
  switch (curve_class) {
    case CurveClass::Circle:
      widths[0] = kSizeWidth;
      break;
    case CurveClass::Ellipse:
      // m uniform in (-1, 0). Places are touched by their share of the perimeter, most densely, by
      // direction, on the flat sides. A pose turned by half a turn is the same: half of it is all.
      widths.head<3>() << kSizeWidth, kUniformWidth,
          2.0 * quarter_perimeter_over_a(z[1]) * std::sqrt(z[1]) * kUniformWidth;
      break;
    case CurveClass::Hyperbola:
      // Of the half about the tip. Three quarters of the law of m are positive. The place is w = e
      // y / p, as which curvature falls: p kappa = (1 + w^2)^(-3/2), e = 1 the parabola's.
      widths.head<3>() << kSizeWidth, 0.75 * kEccentricity.width(), kSlope.width();
      break;
    case CurveClass::Parabola:
      widths.head<2>() << kSizeWidth, kSlope.width();
      break;
    case CurveClass::CubicalParabola:
      // Either sign of a; half a turn maps the curve to itself, so places have half.
      widths.head<3>() << 2.0 * kSizeWidth, kSlope.width(), 0.5 * kPlaceFromInflection.width();
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      widths.head<4>() << kSizeWidth, kSlope.width(), kPlaceFromCusp.width(), kBend.width();
      if (curve_class == CurveClass::SemiCubicalParabola) {
        widths[3] = 0.0;
      }
      break;
    default:
      break;
  }
  const int own = shape_coordinates(curve_class);
  if (chart.as_arc) {
    for (int k = 0; k < own; ++k) {
      widths[k] = law_of_arc(k).width();
    }
  }
  widths[own] = kCauchyWidth;  // offset, in half extents
  // Turn: any direction. A line is the same either way of travel; what bends is not.
  widths[own + 1] = (curve_class == CurveClass::Line ? kPi : 2.0 * kPi) * kUniformWidth;
  return widths;
}

double log_prior(Chart chart, const TouchedVector& z) {
  const CurveClass curve_class = chart.curve_class;
  if (chart.as_arc) {
    // Half of the spline's; an arc is the same travelled either way, and one of them has a
    // spline's t.
    double sum = 0.0;
    for (int k = 0; k < shape_coordinates(curve_class); ++k) {
      sum += law_of_arc(k).log(z[k]);
    }
    return sum;
  }
  if (shape_coordinates(curve_class) == 0) {
    return 0.0;
  }
  const double of_size = log_of_size(log_size(curve_class, z));
  switch (curve_class) {
    case CurveClass::Ellipse:
      return of_size - 1.5 * std::log(tip_likeness(z[1], z[2]) / z[1]);
    case CurveClass::Parabola:
      return of_size + kSlope.log(z[1]);
    case CurveClass::Hyperbola:
      return log_add(log_prior_of_half(HyperbolaHalf::Tip, z),
                     log_prior_of_half(HyperbolaHalf::Wedge, z)) -
             std::numbers::ln2;
    case CurveClass::CubicalParabola:
      return of_size + kSlope.log(z[1]) + kPlaceFromInflection.log(z[2]);
    case CurveClass::SemiCubicalParabola:
      return of_size + kSlope.log(z[1]) + kPlaceFromCusp.log(z[2]);
    case CurveClass::CubicSpline:
      return of_size + kSlope.log(z[1]) + kPlaceFromCusp.log(z[2]) + kBend.log(z[3]) -
             std::numbers::ln2;
    default:
      return of_size;
  }
}

double log_density(Chart chart, const TouchedVector& z) {
  const TouchedVector widths = prior_widths(chart, z);
  double sum = log_prior(chart, z);
  for (int k = 0; k < shape_coordinates(chart.curve_class); ++k) {
    sum -= std::log(widths[k]);
  }
  return sum;
}

TouchedVector log_prior_gradient(Chart chart, const TouchedVector& z) {
  const CurveClass curve_class = chart.curve_class;
  TouchedVector gradient = TouchedVector::Zero();
  if (chart.as_arc) {
    for (int k = 0; k < shape_coordinates(curve_class); ++k) {
      gradient[k] = law_of_arc(k).derivative(z[k]);
    }
    return gradient;
  }
  if (shape_coordinates(curve_class) > 0) {
    gradient[0] = log_of_size_derivative(log_size(curve_class, z));
  }
  switch (curve_class) {
    case CurveClass::Ellipse: {
      const double likeness = tip_likeness(z[1], z[2]);
      const double cosine = std::cos(z[2]);
      gradient[1] = gradient[0] * log_diagonal_derivative(z[1]) -
                    1.5 * (cosine * cosine / likeness - 1.0 / z[1]);
      gradient[2] = -1.5 * (1.0 - z[1]) * std::sin(2.0 * z[2]) / likeness;
      break;
    }
    case CurveClass::Parabola:
      gradient[1] = kSlope.derivative(z[1]);
      break;
    case CurveClass::Hyperbola: {
      gradient[1] = kEccentricity.derivative(z[1] - 1.0);
      gradient[2] = kSlope.derivative(z[2]);
      const double share = share_of_wedges(z);
      if (share > 0.0) {
        const double m = z[1];
        const double by_w = wedge_place_over_w(m);
        const double of_place = kSlope.derivative(by_w * z[2]);
        TouchedVector of_wedge = TouchedVector::Zero();
        of_wedge[0] = log_of_size_derivative(log_size_of_wedge(z));
        of_wedge[1] = of_wedge[0] * log_diagonal_derivative(m) - 2.0 / (1.0 + m) +
                      0.5 / (m * (1.0 + m)) * (1.0 + of_place * z[2] * by_w);
        of_wedge[2] = of_place * by_w;
        gradient += share * (of_wedge - gradient);
      }
      break;
    }
    case CurveClass::CubicalParabola:
      gradient[1] = kSlope.derivative(z[1]);
      gradient[2] = kPlaceFromInflection.derivative(z[2]);
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      gradient[1] = kSlope.derivative(z[1]);
      gradient[2] = kPlaceFromCusp.derivative(z[2]);
      if (curve_class == CurveClass::CubicSpline) {
        gradient[3] = kBend.derivative(z[3]);
      }
      break;
    default:
      break;
  }
  return gradient;
}

// -log of each tailed law is concave in the square of the distance from its centre: the parabola
// about the centre with the slope that it has at z is above it (D. Hunter and K. Lange, "A tutorial
// on MM algorithms", 2004).
TouchedVector tail_weights(Chart chart, const TouchedVector& z) {
  const CurveClass curve_class = chart.curve_class;
  TouchedVector weights = TouchedVector::Ones();
  if (shape_coordinates(curve_class) == 0) {
    return weights;
  }
  const TouchedVector slope = log_prior_gradient(chart, z);
  const TouchedVector widths = prior_widths(chart, z);
  TouchedVector away = z - prior_centre(chart);
  if (curve_class == CurveClass::Ellipse) {
    away.head<3>() << log_size(curve_class, z), 0.0, std::remainder(z[2], kPi);  // m has no tail
  } else if (curve_class == CurveClass::Hyperbola && share_of_wedges(z) > 0.5) {
    away.head<2>() << log_size_of_wedge(z), 0.0;  // nor has b / c
  }
  for (int k = 0; k < shape_coordinates(curve_class); ++k) {
    const double curvature = away[k] != 0.0 ? -slope[k] / away[k] : 0.0;
    if (curvature > 0.0) {
      weights[k] = std::min(1.0, curvature * widths[k] * widths[k]);
    }
  }
  return weights;
}

}  // namespace palpate
