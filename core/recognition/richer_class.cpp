#include "core/recognition/richer_class.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kStandardDeviations = 2.0;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// |value| + two standard deviations of a function of the shape with the given gradient.
double reach(double value, const Eigen::Vector3d& gradient, const CanonicalFit& fit,
             double inflation) {
  const auto letters = static_cast<Eigen::Index>(parameter_letters(fit.shape.curve_class).size());
  const double variance =
      inflation * gradient.head(letters).dot(fit.covariance.topLeftCorner(letters, letters) *
                                             gradient.head(letters));
  return std::isfinite(variance)
             ? std::abs(value) + kStandardDeviations * std::sqrt(std::max(variance, 0.0))
             : kUnbounded;
}

/// Of a conic whose optimum is the parabola, as far as rounding tells: two standard deviations of
/// its |1 - e^2|. With quadratic part A, B, C that is |4 A C - B^2| / (A + C)^2 to first order
/// about 0.
double departure_of_the_parabola_itself(const Weighing& w) {
  const auto& fit = w.fits[static_cast<std::size_t>(CurveClass::Parabola)];
  if (!fit || !fit->polynomial) {
    return kUnbounded;
  }
  const ConicCoefficients q = conic_of_parabola(*fit->polynomial);
  ConicCoefficients gradient = ConicCoefficients::Zero();
  gradient.head<3>() << 4.0 * q[2], -2.0 * q[1], 4.0 * q[0];
  gradient /= (q[0] + q[2]) * (q[0] + q[2]);
  // The side of the tips does not enter: the information is that of the curve through the surface
  // points.
  return kStandardDeviations * std::sqrt(w.inflation) * conic_deviation(w.data.points, q, gradient);
}

}  // namespace

bool is_limit_of(CurveClass limit, CurveClass richer) {
  switch (limit) {
    case CurveClass::Line:
      return richer == CurveClass::Circle;
    case CurveClass::Circle:
      return richer == CurveClass::Ellipse;
    case CurveClass::Parabola:
      return richer == CurveClass::Ellipse || richer == CurveClass::Hyperbola;
    case CurveClass::SemiCubicalParabola:
      return richer == CurveClass::CubicSpline;
    default:
      return false;
  }
}

double largest_departure(const Weighing& w, CurveClass limit) {
  const auto fit_of = [&](CurveClass curve_class) -> const CanonicalFit* {
    const auto& fit = w.canonical[static_cast<std::size_t>(curve_class)];
    return fit ? &*fit : nullptr;
  };
  switch (limit) {
    case CurveClass::Line: {
      // The arc's turn: extent over radius.
      const CanonicalFit* circle = fit_of(CurveClass::Circle);
      if (circle == nullptr) {
        return 0.0;  // as flat as a line to rounding
      }
      const double radius = circle->shape.values[0];
      const double extent = 2.0 * w.data.scale;
      return reach(extent / radius, {-extent / (radius * radius), 0.0, 0.0}, *circle, w.inflation);
    }
    case CurveClass::Circle: {
      // 1 - b / a.
      const CanonicalFit* ellipse = fit_of(CurveClass::Ellipse);
      if (ellipse == nullptr) {
        return kUnbounded;
      }
      const double a = ellipse->shape.values[0];
      const double b = ellipse->shape.values[1];
      return reach(1.0 - b / a, {b / (a * a), -1.0 / a, 0.0}, *ellipse, w.inflation);
    }
    case CurveClass::Parabola: {
      // b^2 / a^2 = |1 - e^2| of the conic; there is one optimum, or none but the parabola itself.
      double least = kUnbounded;
      for (const CurveClass conic : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
        if (const CanonicalFit* fit = fit_of(conic)) {
          const double a = fit->shape.values[0];
          const double b = fit->shape.values[1];
          const double ratio = b * b / (a * a);
          least = std::min(
              least, reach(ratio, {-2.0 * ratio / a, 2.0 * ratio / b, 0.0}, *fit, w.inflation));
        }
      }
      return std::isfinite(least) ? least : departure_of_the_parabola_itself(w);
    }
    case CurveClass::SemiCubicalParabola: {
      // c t against x = t^2, where x is the half extent.
      const CanonicalFit* spline = fit_of(CurveClass::CubicSpline);
      if (spline == nullptr) {
        return kUnbounded;
      }
      const double root = std::sqrt(w.data.scale);
      return reach(spline->shape.values[2] / root, {0.0, 0.0, 1.0 / root}, *spline, w.inflation);
    }
    default:
      return 0.0;
  }
}

}  // namespace palpate
