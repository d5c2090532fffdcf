#include "core/invariants/signature_fit/local_parameter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/curves/pose2.h"
#include "core/invariants/canonical_point.h"

namespace palpate {
namespace {

ParameterCandidates ellipse_candidates(const Eigen::Vector3d& p, double c, double s) {
  ParameterCandidates candidates;
  const double t = std::atan2(-c * p[1], s * p[0]);
  candidates.add(t);
  candidates.add(t + kPi);  // for the opposite direction of travel
  return candidates;
}

ParameterCandidates hyperbola_candidates(const Eigen::Vector3d& p, double c, double s, double kappa,
                                         double kappa_s) {
  ParameterCandidates candidates;
  // tan(angle) = b cosh t / (a sinh t); beyond the angle of the asymptotes there is no point.
  const double tanh_t = p[1] * c / (p[0] * s);
  if (std::abs(tanh_t) < 1.0) {
    candidates.add(std::atanh(tanh_t));
  }
  candidates.add(hyperbola_parameter(p[0], p[1], kappa, kappa_s));
  // |t| from |kappa| alone: a^2 sinh^2 t + b^2 cosh^2 t = (a b / |kappa|)^(2/3).
  const double root = std::cbrt(p[0] * p[1] / std::abs(kappa));
  const double sum = p[0] * p[0] + p[1] * p[1];
  const double cosh_2t = (2.0 * root * root + p[0] * p[0] - p[1] * p[1]) / sum;
  candidates.add(std::copysign(0.5 * std::acosh(std::max(cosh_2t, 1.0)), tanh_t));
  return candidates;
}

ParameterCandidates cubical_candidates(const Eigen::Vector3d& p, double c, double s, double kappa) {
  ParameterCandidates candidates;
  candidates.add(kappa / (6.0 * p[0] * c * c * c));
  // tan(angle) = 3 a t^2 + c, on both sides of the inflection.
  const double t = std::sqrt(std::max(0.0, (s / c - p[1]) / (3.0 * p[0])));
  candidates.add(t);
  candidates.add(-t);
  return candidates;
}

ParameterCandidates semi_cubical_candidates(const Eigen::Vector3d& p, double c, double s,
                                            double kappa) {
  ParameterCandidates candidates;
  candidates.add(0.75 * p[0] * c * c * c / kappa);
  candidates.add((s / c - p[1]) / (1.5 * p[0]));  // tan(angle) = 1.5 a t + b
  return candidates;
}

/// The candidates from (45) and (46).
ParameterCandidates cubic_spline_candidates(const Eigen::Vector3d& p, double angle, double kappa,
                                            double kappa_s) {
  ParameterCandidates candidates;
  const CanonicalPoint<double> point = canonical_point(angle, kappa, kappa_s);
  const double c2 = point.cosine * point.cosine;
  const double e = point.sine - p[1] * point.cosine;  // (lambda - b) cosine
  // (45) and (46), with t^2 eliminated.
  const double numerator = point.cosine * (3.0 * p[0] * e * c2 - 2.0 * p[2] * kappa);
  const double denominator = 9.0 * p[0] * p[0] * c2 * c2 - 4.0 * e * kappa;
  candidates.add(numerator / denominator);
  // (45) times the cosine: 3 a t^2 cosine - 2 e t + c cosine = 0, solved by the stable formula.
  const double discriminant = std::max(0.0, e * e - 3.0 * p[0] * p[2] * c2);
  const double half = e + std::copysign(std::sqrt(discriminant), e);
  candidates.add(half / (3.0 * p[0] * point.cosine));
  candidates.add(p[2] * point.cosine / half);
  return candidates;
}

}  // namespace

void ParameterCandidates::add(double t) {
  constexpr double kLargest = 1e6;  // beyond it powers of t leave the range of a double
  values_[count_++] = std::isfinite(t) ? std::clamp(t, -kLargest, kLargest) : 0.0;
}

double hyperbola_parameter(double a, double b, double kappa, double kappa_s) {
  const double ratio = a * b / kappa;
  return 0.5 * std::asinh(2.0 * kappa_s * ratio * ratio / (3.0 * a * b * (a * a + b * b)));
}

double parabola_parameter(double kappa, double kappa_s) { return kappa_s / (3.0 * kappa * kappa); }

ParameterCandidates candidate_parameters(CurveClass curve_class, const Eigen::Vector3d& p,
                                         double angle, double kappa, double kappa_s) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  ParameterCandidates candidates;
  switch (curve_class) {
    case CurveClass::Ellipse:
      return ellipse_candidates(p, c, s);
    case CurveClass::Parabola:
      candidates.add(c / s);
      candidates.add(parabola_parameter(kappa, kappa_s));
      return candidates;
    case CurveClass::Hyperbola:
      return hyperbola_candidates(p, c, s, kappa, kappa_s);
    case CurveClass::CubicalParabola:
      return cubical_candidates(p, c, s, kappa);
    case CurveClass::SemiCubicalParabola:
      return semi_cubical_candidates(p, c, s, kappa);
    case CurveClass::CubicSpline:
      return cubic_spline_candidates(p, angle, kappa, kappa_s);
    case CurveClass::Line:
    case CurveClass::Circle:
    case CurveClass::Unclassified:
      break;
  }
  assert(false);
  return candidates;
}

}  // namespace palpate
