#include "tests/property/curves/random_curves.h"

#include <cmath>

namespace palpate {

RandomCurve random_curve(CurveClass curve_class, std::mt19937_64& rng) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  double reach = 1.5;
  switch (curve_class) {
    case CurveClass::Unclassified:
    case CurveClass::Line:
      break;
    case CurveClass::Circle:
      v[0] = uniform(rng, 0.3, 3.0);
      reach = kPi;
      break;
    case CurveClass::Ellipse:
      v[0] = uniform(rng, 1.0, 2.0);
      v[1] = uniform(rng, 0.05, 1.0);
      reach = kPi;
      break;
    case CurveClass::Parabola:
      v[0] = uniform(rng, 0.2, 3.0);
      break;
    case CurveClass::Hyperbola:
      v = {uniform(rng, 0.2, 3.0), uniform(rng, 0.2, 3.0), 0.0};
      break;
    case CurveClass::CubicalParabola:
      v = {random_sign(rng) * uniform(rng, 0.1, 3.0), uniform(rng, -2.0, 2.0), 0.0};
      break;
    case CurveClass::SemiCubicalParabola:
      v = {uniform(rng, 0.1, 3.0), uniform(rng, -2.0, 2.0), 0.0};
      break;
    case CurveClass::CubicSpline:
      v = {uniform(rng, 0.1, 3.0), uniform(rng, -2.0, 2.0),
           random_sign(rng) * uniform(rng, 0.05, 2.0)};
      break;
  }
  return {*make_curve(curve_class, v), v, -reach, reach};
}

Curve scaled(const RandomCurve& random, double factor) {
  const CurveClass curve_class = class_of(random.curve);
  Eigen::Vector3d v = random.values * factor;
  if (curve_class == CurveClass::CubicalParabola) {
    v = {random.values[0] / (factor * factor), random.values[1], 0.0};
  } else if (curve_class == CurveClass::SemiCubicalParabola ||
             curve_class == CurveClass::CubicSpline) {
    const double root = std::sqrt(factor);
    v = {random.values[0] / root, random.values[1], random.values[2] * root};
  }
  return *make_curve(curve_class, v);
}

double scaled_parameter(CurveClass curve_class, double t, double factor) {
  switch (curve_class) {
    case CurveClass::Line:
    case CurveClass::CubicalParabola:
      return t * factor;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return t * std::sqrt(factor);
    default:
      return t;
  }
}

}  // namespace palpate
