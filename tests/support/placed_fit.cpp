#include "tests/support/placed_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/conic_equation.h"

namespace palpate::test {

ClassFit placed_fit(const ShapeParameters& shape, const Pose2& world_T_curve, const FitData& data,
                    std::span<const double> t) {
  ClassFit fit;
  fit.curve_class = shape.curve_class;
  Pose2 pose = data.frame.inverse() * world_T_curve;
  const Eigen::Vector3d& v = shape.values;
  PolynomialFit polynomial;
  PolynomialCoefficients& c = polynomial.coefficients;
  switch (shape.curve_class) {
    case CurveClass::Parabola:
      c.col(1) = Vec2(0.0, 2.0 * v[0]);
      c.col(2) = Vec2(v[0], 0.0);
      break;
    case CurveClass::CubicalParabola:
      c.col(1) = Vec2(1.0, v[1]);
      c.col(3) = Vec2(0.0, v[0]);
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      c.col(1) = Vec2(0.0, shape.curve_class == CurveClass::CubicSpline ? v[2] : 0.0);
      c.col(2) = Vec2(1.0, v[1]);
      c.col(3) = Vec2(0.0, v[0]);
      break;
    default: {
      pose.x /= data.scale;
      pose.y /= data.scale;
      Eigen::Vector3d values = v;
      if (shape.curve_class != CurveClass::Line) {
        values /= data.scale;
      }
      ImplicitFit implicit;
      implicit.coefficients = conic_of(shape.curve_class, values, pose);
      fit.implicit = implicit;
      return fit;
    }
  }
  for (int k = 0; k < 4; ++k) {
    c.col(k) = pose.rotate(c.col(k)) / data.scale;
  }
  c.col(0) += pose.translation() / data.scale;
  // Scale t to [-1, 1], as in all fits.
  double reach = 0.0;
  for (const double at : t) {
    reach = std::max(reach, std::abs(at));
  }
  for (int k = 1; k < 4; ++k) {
    c.col(k) *= std::pow(reach, k);
  }
  for (const double at : t) {
    polynomial.t.push_back(at / reach);
  }
  fit.polynomial = std::move(polynomial);
  return fit;
}

}  // namespace palpate::test
