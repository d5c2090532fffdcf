#include "tests/support/conic_equation.h"

#include <cassert>
#include <cmath>

namespace palpate::test {

ConicCoefficients conic_of(CurveClass curve_class, const Eigen::Vector3d& values,
                           const Pose2& world_T_curve) {
  // alpha u^2 + beta v^2 + gamma u + delta = 0 (line: v = 0) in the curve's own frame.
  const double a = values[0];
  const double b = values[1];
  double alpha = 0.0;
  double beta = 0.0;
  double gamma = 0.0;
  double delta = 0.0;
  double along_v = 0.0;
  switch (curve_class) {
    case CurveClass::Line:
      along_v = 1.0;
      break;
    case CurveClass::Circle:
      alpha = beta = 1.0;
      delta = -a * a;
      break;
    case CurveClass::Ellipse:
      alpha = b / a;
      beta = a / b;
      delta = -a * b;
      break;
    case CurveClass::Parabola:
      beta = 1.0;
      gamma = -4.0 * a;
      break;
    case CurveClass::Hyperbola:
      alpha = b / a;
      beta = -a / b;
      delta = -a * b;
      break;
    default:
      assert(false);
  }
  // u = c x + s y + u0, v = -s x + c y + v0.
  const double c = std::cos(world_T_curve.theta);
  const double s = std::sin(world_T_curve.theta);
  const Vec2 origin = world_T_curve.to_local(Vec2::Zero());
  const double u0 = origin.x();
  const double v0 = origin.y();
  ConicCoefficients q;
  q << alpha * c * c + beta * s * s, 2.0 * c * s * (alpha - beta), alpha * s * s + beta * c * c,
      c * (2.0 * alpha * u0 + gamma) - s * (2.0 * beta * v0 + along_v),
      s * (2.0 * alpha * u0 + gamma) + c * (2.0 * beta * v0 + along_v),
      alpha * u0 * u0 + beta * v0 * v0 + gamma * u0 + along_v * v0 + delta;
  return q / q.stableNorm();
}

}  // namespace palpate::test
