#include "core/curves/algebraic/canonical_cubic.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/numerics/double_double.h"

namespace palpate {
namespace {

/// A coefficient after one rotation (two products, a sum, sine and cosine) and one change of
/// parameter (at most five roundings) has an error of up to 16 * 2^-53 of its terms' sizes, and two
/// such coefficients occur in a component.
constexpr double kCubicRounding = 16.0 * std::numeric_limits<double>::epsilon();

CubicCanonicalisation degenerate(CubicDegeneracy degeneracy, const Pose2& pose = {}) {
  return {std::nullopt, degeneracy, pose};
}

CubicCanonicalisation finished(const CanonicalCubic& curve) {
  const Pose2& pose = curve.world_T_curve;
  const bool finite = curve.values.allFinite() && std::isfinite(pose.x) && std::isfinite(pose.y) &&
                      std::isfinite(curve.canonical_t.scale) &&
                      std::isfinite(curve.canonical_t.shift) && curve.canonical_t.scale != 0.0;
  // A leading parameter that underflows is not a canonical form either.
  const bool in_range = curve.curve_class == CurveClass::Line || curve.values[0] != 0.0;
  if (!finite || !in_range) {
    return degenerate(CubicDegeneracy::OutOfRange);
  }
  return {curve, CubicDegeneracy::None, pose};
}

CubicCanonicalisation as_line(const PolynomialCurve2& curve) {
  const Vec2 direction = curve.coefficients.col(1);
  if (direction.isZero(0.0)) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  CanonicalCubic line;
  line.curve_class = CurveClass::Line;
  line.world_T_curve = pose_along(curve.coefficients.col(0), direction);
  line.canonical_t = {direction.stableNorm(), 0.0};
  return finished(line);
}

/// Frame of c0 + c1 t + c2 t^2, c2 not 0.
struct QuadraticFrame {
  double opening;  ///< |c2|
  Vec2 x_axis;     ///< along c2
  double along;    ///< component of c1 along it
  double across;   ///< component of c1 to its left: 0 for a half-line
  double vertex;   ///< t at the vertex
  Vec2 vertex_position;

  explicit QuadraticFrame(const PolynomialCurve2& curve) {
    const Vec2 c1 = curve.coefficients.col(1);
    const Vec2 c2 = curve.coefficients.col(2);
    opening = c2.stableNorm();
    x_axis = c2 / opening;
    along = accurate_dot(c2, c1) / opening;
    across = accurate_cross(c2, c1) / opening;
    vertex = -along / (2.0 * opening);
    vertex_position = curve.coefficients.col(0) + vertex * (c1 + vertex * c2);
  }
};

CubicCanonicalisation as_parabola(const PolynomialCurve2& curve) {
  if (curve.coefficients.col(2).isZero(0.0)) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  const QuadraticFrame frame(curve);
  if (frame.across == 0.0) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  CanonicalCubic parabola;
  parabola.curve_class = CurveClass::Parabola;
  parabola.values[0] = 0.25 * frame.across * (frame.across / frame.opening);
  parabola.world_T_curve = pose_along(frame.vertex_position, frame.x_axis);
  parabola.canonical_t.scale = 2.0 * (frame.opening / frame.across);
  parabola.canonical_t.shift = frame.along / frame.across;
  return finished(parabola);
}

/// (54): the x axis is normal to c3, so x = c2 t^2 + c1 t and y = d3 t^3 + d2 t^2 + d1 t. Member
/// names: x and y for the component, the digit for the power of t.
struct CubicFrame {
  double y3;  ///< |c3|: the y axis is along c3
  Vec2 x_axis;
  double x2, x1, y2, y1;
  double size2, size1;  ///< |c2|, |c1|

  explicit CubicFrame(const PolynomialCurve2& curve) {
    const Vec2 c1 = curve.coefficients.col(1);
    const Vec2 c2 = curve.coefficients.col(2);
    const Vec2 c3 = curve.coefficients.col(3);
    y3 = c3.stableNorm();
    x_axis = -left_of(c3) / y3;
    x2 = accurate_cross(c2, c3) / y3;
    x1 = accurate_cross(c1, c3) / y3;
    y2 = accurate_dot(c2, c3) / y3;
    y1 = accurate_dot(c1, c3) / y3;
    size2 = c2.stableNorm();
    size1 = c1.stableNorm();
  }
};

CubicCanonicalisation as_cubical(const PolynomialCurve2& curve) {
  if (curve.coefficients.col(3).isZero(0.0)) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  const CubicFrame frame(curve);
  if (frame.x1 == 0.0) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  const double inflection = -frame.y2 / (3.0 * frame.y3);
  CanonicalCubic cubical;
  cubical.curve_class = CurveClass::CubicalParabola;
  cubical.values[0] = frame.y3 / frame.x1 / frame.x1 / frame.x1;
  cubical.values[1] = (frame.y1 + inflection * frame.y2) / frame.x1;
  const Vec2 left_out = frame.x2 * inflection * inflection * frame.x_axis;
  cubical.world_T_curve = pose_along(curve.position(inflection) - left_out, frame.x_axis);
  cubical.canonical_t = {frame.x1, -inflection * frame.x1};
  return finished(cubical);
}

/// The vertex x' = 0 of a cubic with x2 != 0, and y' there.
struct SplineVertex {
  double t;
  double slope_y;  ///< y1 + 2 y2 t + 3 y3 t^2; 0 for a cusp
  double size;  ///< size of the terms whose relative errors enter, including the error of t itself

  explicit SplineVertex(const CubicFrame& frame)
      : t(-frame.x1 / (2.0 * frame.x2)),
        slope_y(static_cast<double>(
            DoubleDouble(frame.y1) +
            DoubleDouble(t) * (DoubleDouble(2.0 * frame.y2) + DoubleDouble(3.0 * frame.y3) * t))),
        size(frame.size1 + std::abs(t) * (2.0 * frame.size2 + 3.0 * frame.y3 * std::abs(t)) +
             std::abs(frame.y2 + 3.0 * frame.y3 * t) *
                 (frame.size1 + 2.0 * std::abs(t) * frame.size2) / std::abs(frame.x2)) {}
};

CubicCanonicalisation as_spline(CurveClass curve_class, const PolynomialCurve2& curve) {
  if (curve.coefficients.col(3).isZero(0.0)) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  const CubicFrame frame(curve);
  if (frame.x2 == 0.0) {
    return degenerate(CubicDegeneracy::OutsideClass);
  }
  const SplineVertex vertex(frame);
  // For c2 < 0 the frame is turned by pi, which changes the sign of both axes. The direction of u
  // is chosen so that a > 0.
  const double turn = std::copysign(1.0, frame.x2);
  const double quadratic = std::abs(frame.x2);
  const double root = turn * std::sqrt(quadratic);  // du/dt
  CanonicalCubic spline;
  spline.curve_class = curve_class;
  spline.values[0] = frame.y3 / (quadratic * std::sqrt(quadratic));
  spline.values[1] = turn * (frame.y2 + 3.0 * vertex.t * frame.y3) / quadratic;
  if (curve_class == CurveClass::CubicSpline) {
    spline.values[2] = turn * vertex.slope_y / root;
    if (spline.values[2] == 0.0) {
      return degenerate(CubicDegeneracy::OutsideClass);
    }
  }
  spline.world_T_curve = pose_along(curve.position(vertex.t), turn * frame.x_axis);
  spline.canonical_t = {root, -vertex.t * root};
  return finished(spline);
}

/// Polynomials along one line; `degree` (2 or 3) is the highest power with a coefficient other than
/// 0.
CubicCanonicalisation straight(const PolynomialCurve2& curve, int degree) {
  const Vec2 direction = curve.coefficients.col(degree);
  if (degree == 2) {
    return degenerate(CubicDegeneracy::HalfLine,
                      pose_along(QuadraticFrame(curve).vertex_position, direction));
  }
  return degenerate(CubicDegeneracy::UnevenLine, pose_along(curve.coefficients.col(0), direction));
}

/// Chooses the class. t is measured from the middle of its range; `half` is half the length of the
/// range.
CubicCanonicalisation decide(const PolynomialCurve2& curve, double half, double distance) {
  const auto& c = curve.coefficients;
  const auto absent = [&](int power) {
    return c.col(power).isZero(0.0) || c.col(power).norm() * std::pow(half, power) <= distance;
  };
  if (!absent(3)) {
    const CubicFrame frame(curve);
    if (std::abs(frame.x2) > std::max(kCubicRounding * frame.size2, distance / (half * half))) {
      const SplineVertex vertex(frame);
      const double rounding = kCubicRounding * vertex.size;
      const double from_vertex = half + std::abs(vertex.t);
      const bool cusp = std::abs(vertex.slope_y) <= std::max(rounding, distance / from_vertex);
      return as_spline(cusp ? CurveClass::SemiCubicalParabola : CurveClass::CubicSpline, curve);
    }
    const double inflection = frame.y2 / (3.0 * frame.y3);
    const double x1_rounding = kCubicRounding * (frame.size1 + std::abs(inflection) * frame.size2);
    if (std::abs(frame.x1) > std::max(x1_rounding, distance / half)) {
      return as_cubical(curve);
    }
    return straight(curve, 3);
  }
  if (!absent(2)) {
    const QuadraticFrame frame(curve);
    if (std::abs(frame.across) > std::max(kCubicRounding * c.col(1).norm(), distance / half)) {
      return as_parabola(curve);
    }
    return straight(curve, 2);
  }
  if (!absent(1)) {
    return as_line(curve);
  }
  return degenerate(CubicDegeneracy::Point, {c(0, 0), c(1, 0), 0.0});
}

}  // namespace

std::string_view describe(CubicDegeneracy degeneracy) {
  switch (degeneracy) {
    case CubicDegeneracy::None:
      return "none";
    case CubicDegeneracy::NotFinite:
      return "a coefficient is not finite";
    case CubicDegeneracy::OutOfRange:
      return "the canonical parameters leave the range of a double";
    case CubicDegeneracy::Point:
      return "a point";
    case CubicDegeneracy::HalfLine:
      return "a half-line covered twice";
    case CubicDegeneracy::UnevenLine:
      return "a line with a cubic term along it";
    case CubicDegeneracy::OutsideClass:
      return "no curve of the class asked for";
  }
  assert(false);
  return "";
}

CubicCanonicalisation canonicalise(const PolynomialCurve2& curve,
                                   const CanonicalCubicOptions& options) {
  assert(options.distance_m >= 0.0 && options.t_lower < options.t_upper);
  if (!curve.coefficients.allFinite()) {
    return degenerate(CubicDegeneracy::NotFinite);
  }
  if (options.distance_m == 0.0) {
    return decide(curve, 1.0, 0.0);
  }
  const double middle = 0.5 * (options.t_lower + options.t_upper);
  CubicCanonicalisation result =
      decide(curve.shifted(middle), 0.5 * (options.t_upper - options.t_lower), options.distance_m);
  if (result.curve) {
    result.curve->canonical_t.shift -= result.curve->canonical_t.scale * middle;
  }
  return result;
}

CubicCanonicalisation canonicalise_as(CurveClass curve_class, const PolynomialCurve2& curve) {
  if (!curve.coefficients.allFinite()) {
    return degenerate(CubicDegeneracy::NotFinite);
  }
  switch (curve_class) {
    case CurveClass::Line:
      return as_line(curve);
    case CurveClass::Parabola:
      return as_parabola(curve);
    case CurveClass::CubicalParabola:
      return as_cubical(curve);
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return as_spline(curve_class, curve);
    default:
      assert(false);
      return degenerate(CubicDegeneracy::OutsideClass);
  }
}

}  // namespace palpate
