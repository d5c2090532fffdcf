#include "core/invariants/signature_fit/local_parameter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/curves/pose2.h"
#include "core/invariants/canonical_point.h"
#include "core/invariants/signature_fit/canonical_models.h"

namespace palpate {
namespace {

/// |t| of a seed; beyond it powers of t leave nothing of a double.
constexpr double kLargestParameter = 1e6;

double bounded(double t) {
  return std::isfinite(t) ? std::clamp(t, -kLargestParameter, kLargestParameter) : 0.0;
}

int sign_of(double value) { return value < 0.0 ? -1 : 1; }

/// sinh 2t = 2 kappa_s E^3 / (3 a b (a^2 + b^2)) with E^3 = (a b / kappa)^2: signed, no choice
/// left.
double hyperbola_t(double a, double b, double kappa, double kappa_s) {
  const double ratio = a * b / kappa;
  return 0.5 * std::asinh(2.0 * kappa_s * ratio * ratio / (3.0 * a * b * (a * a + b * b)));
}

/// Of the parameters that (45) and (46) offer, the one whose geometry is nearest.
double cubic_spline_t(const Eigen::Vector3d& p, double angle, double kappa, double kappa_s) {
  const CanonicalPoint<double> point = canonical_point(angle, kappa, kappa_s);
  const double c2 = point.cosine * point.cosine;
  const double e = point.sine - p[1] * point.cosine;  // (lambda - b) cosine
  // (45) and (46) without t^2.
  const double numerator = point.cosine * (3.0 * p[0] * e * c2 - 2.0 * p[2] * kappa);
  const double denominator = 9.0 * p[0] * p[0] * c2 * c2 - 4.0 * e * kappa;
  // (45) times the cosine: 3 a t^2 cosine - 2 e t + c cosine = 0, by the stable formula.
  const double discriminant = std::max(0.0, e * e - 3.0 * p[0] * p[2] * c2);
  const double half = e + std::copysign(std::sqrt(discriminant), e);
  const std::array candidates = {bounded(numerator / denominator),
                                 bounded(half / (3.0 * p[0] * point.cosine)),
                                 bounded(p[2] * point.cosine / half)};
  double best = 0.0;
  double best_misfit = std::numeric_limits<double>::infinity();
  const double size = std::max(std::abs(kappa), std::sqrt(std::abs(kappa_s)));
  for (const double t : candidates) {
    const auto model = geometry_of(CubicSplineModel::derivatives(p.data(), t));
    const double sign = std::cos(angle - model.tangent_angle) < 0.0 ? -1.0 : 1.0;
    const double misfit = std::abs(std::sin(angle - model.tangent_angle)) +
                          std::abs(kappa - sign * model.kappa) / size +
                          std::abs(kappa_s - model.kappa_s) / (size * size);
    if (misfit < best_misfit) {
      best_misfit = misfit;
      best = t;
    }
  }
  return best;
}

}  // namespace

LocalParameter local_parameter(CurveClass curve_class, const Eigen::Vector3d& p, double angle,
                               double kappa, double kappa_s) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  switch (curve_class) {
    case CurveClass::Ellipse: {
      const int direction = sign_of(kappa);
      return {std::atan2(-direction * c * p[1], direction * s * p[0]), direction};
    }
    case CurveClass::Parabola:
      return {bounded(kappa_s / (3.0 * kappa * kappa)), -sign_of(kappa)};
    case CurveClass::Hyperbola:
      return {bounded(hyperbola_t(p[0], p[1], kappa, kappa_s)), -sign_of(kappa)};
    case CurveClass::CubicalParabola:
      return {bounded(kappa / (6.0 * p[0] * c * c * c)), sign_of(c)};
    case CurveClass::SemiCubicalParabola:
      return {bounded(0.75 * p[0] * c * c * c / kappa), sign_of(kappa)};
    case CurveClass::CubicSpline: {
      const double t = cubic_spline_t(p, angle, kappa, kappa_s);
      const auto model = geometry_of(CubicSplineModel::derivatives(p.data(), t));
      return {t, sign_of(std::cos(angle - model.tangent_angle))};
    }
    case CurveClass::Line:
    case CurveClass::Circle:
    case CurveClass::Unclassified:
      break;
  }
  assert(false);
  return {};
}

}  // namespace palpate
