#include "core/recognition/prior/touched_prior.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/probability/log_add.h"
#include "core/recognition/prior/arc_coordinates.h"
#include "core/recognition/prior/arms.h"
#include "core/recognition/prior/bend_laws.h"
#include "core/recognition/prior/ellipse_places.h"
#include "core/recognition/prior/size_law.h"

namespace palpate {
namespace {

/// Widths of normal laws with the height of: a Cauchy law of scale 1; a uniform law over [0, 1].
const double kCauchyWidth = std::sqrt(0.5 * kPi);
const double kUniformWidth = 1.0 / std::sqrt(2.0 * kPi);

/// Of the normal law as high: the density of log(size) is 1 / 2 at the centre.
const double kSizeWidth = 2.0 * kUniformWidth;

/// log of the size of the part over its middle, sqrt(20) half extents.
double log_size(CurveClass curve_class, const TouchedVector& z) {
  const double log_over_length = curve_class == CurveClass::Ellipse
                                     ? log_diagonal_over_p(z[1])
                                     : -log_length_over_size(curve_class);
  return z[0] + log_over_length - kLogSize;
}

/// The share of the arms in a class's prior at z.
double share_of_arms(CurveClass curve_class, const TouchedVector& z) {
  if (!has_arms(curve_class)) {
    return 0.0;
  }
  const double more = log_prior_touched_at(curve_class, TouchedAt::Bend, z) -
                      log_prior_touched_at(curve_class, TouchedAt::Arms, z);
  return kShareOfArms / (kShareOfArms + (1.0 - kShareOfArms) * std::exp(more));
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

double expected_log_length(CurveClass curve_class, TouchedAt at, const TouchedVector& z) {
  return z[0] -
         (at == TouchedAt::Bend ? log_size(curve_class, z) : log_size_of_arms(curve_class, z));
}

double log_prior_touched_at(CurveClass curve_class, TouchedAt at, const TouchedVector& z) {
  if (at == TouchedAt::Arms) {
    return log_prior_of_arms(curve_class, z);
  }
  const double of_size = log_of_size(log_size(curve_class, z));
  switch (curve_class) {
    case CurveClass::Ellipse:
      return of_size - 1.5 * std::log(tip_likeness(z[1], z[2]) / z[1]);
    case CurveClass::Parabola:
      return of_size + kSlope.log(z[1]);
    case CurveClass::Hyperbola:
      return of_size + kEccentricity.log(z[1] - 1.0) + kSlope.log(z[2]);
    case CurveClass::CubicalParabola:
      return of_size + kSlope.log(z[1]) + kPlaceFromInflection.log(z[2]);
    case CurveClass::SemiCubicalParabola:
      return of_size + kSlope.log(z[1]) + kPlaceFromCusp.log(z[2]);
    case CurveClass::CubicSpline:
      return of_size + kSlope.log(z[1]) + kPlaceFromCusp.log(z[2]) + kBend.log(z[3]);
    default:
      return of_size;
  }
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
    centre[0] = expected_log_length(chart.curve_class, TouchedAt::Bend, centre);
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
      // direction, on the flat sides.
      widths.head<3>() << kSizeWidth, kUniformWidth, width_of_direction(z[1]);
      break;
    case CurveClass::Hyperbola:
      // About the tip. Three quarters of the law of m are positive. The place is w = e y / p, as
      // which curvature falls: p kappa = (1 + w^2)^(-3/2), e = 1 the parabola's.
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
  const double of_bend = log_prior_touched_at(curve_class, TouchedAt::Bend, z);
  if (has_arms(curve_class)) {
    return log_add(of_bend + std::log1p(-kShareOfArms),
                   log_prior_touched_at(curve_class, TouchedAt::Arms, z) + std::log(kShareOfArms));
  }
  // Half of the spline's is arcs.
  return curve_class == CurveClass::CubicSpline ? of_bend - std::numbers::ln2 : of_bend;
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
    case CurveClass::Hyperbola:
      gradient[1] = kEccentricity.derivative(z[1] - 1.0);
      gradient[2] = kSlope.derivative(z[2]);
      break;
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
  if (const double share = share_of_arms(curve_class, z); share > 0.0) {
    gradient += share * (gradient_of_arms(curve_class, z) - gradient);
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
  const bool on_arms = share_of_arms(curve_class, z) > 0.5;
  if (on_arms) {
    away[0] = log_size_of_arms(curve_class, z);
  }
  if (curve_class == CurveClass::Ellipse) {
    away[0] = on_arms ? away[0] : log_size(curve_class, z);
    away[1] = 0.0;  // m has no tail
    away[2] = std::remainder(on_arms ? z[2] - 0.5 * kPi : z[2], kPi);
  } else if (curve_class == CurveClass::Hyperbola && on_arms) {
    away[1] = 0.0;  // nor has b / c
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
