#include "tests/paper/random_curves.h"

#include <algorithm>
#include <cmath>

#include "core/invariants/parabola_invariant.h"

namespace palpate::paper {

using test::PlacedCurve;

PlacedCurve curve_of(CurveClass curve_class, double first, double second, double third) {
  return {curve_class, {first, second, third}, {}};
}

PlacedCurve random_curve(CurveClass curve_class, Random& random) {
  const double a = random.uniform(1.0, 3.0);
  switch (curve_class) {
    case CurveClass::Ellipse:
      return curve_of(curve_class, a, a * random.uniform(0.4, 0.85));
    case CurveClass::Parabola:
      return curve_of(curve_class, a);
    case CurveClass::Hyperbola:
      return curve_of(curve_class, a, random.uniform(1.0, 3.0));
    case CurveClass::CubicalParabola:
    case CurveClass::SemiCubicalParabola:
      return curve_of(curve_class, a, random.sign() * random.uniform(0.5, 2.0));
    default:
      return curve_of(curve_class, a, random.sign() * random.uniform(0.5, 2.0),
                      random.sign() * random.uniform(0.5, 2.0));
  }
}

double random_place(const PlacedCurve& curve, Random& random) {
  switch (curve.curve_class) {
    case CurveClass::Ellipse:
      return random.uniform(0.0, 2.0 * kPi);
    case CurveClass::Parabola:
    case CurveClass::Hyperbola:
      return random.uniform(-1.5, 1.5);
    case CurveClass::CubicalParabola:
      return random.sign() * random.uniform(0.15, 0.8);
    case CurveClass::SemiCubicalParabola:
      return random.sign() * random.uniform(0.4, 1.5);
    default:
      return random.sign() * random.uniform(0.25, 1.2);
  }
}

bool are_told_apart(CurveClass curve_class, const MeasuredGeometry& p, const MeasuredGeometry& q) {
  if (curve_class == CurveClass::Ellipse || curve_class == CurveClass::Hyperbola) {
    const double u = 1.0 / curvature_two_thirds(p.kappa);
    const double v = 1.0 / curvature_two_thirds(q.kappa);
    return std::abs(u - v) > 0.15 * std::max(u, v);
  }
  return std::abs(std::sin(p.tangent_angle - q.tangent_angle)) > 0.15;
}

}  // namespace palpate::paper
