// Appendix B on hand-made cubics: every class, every degenerate case, the tolerance.
#include "core/curves/algebraic/canonical_cubic.h"

#include <gtest/gtest.h>

#include <cassert>
#include <cmath>
#include <limits>

#include "core/curves/cubic_spline.h"

namespace palpate {
namespace {

/// The curve at that pose, as polynomials in its canonical parameter.
PolynomialCurve2 polynomial_curve_of(CurveClass curve_class, const Eigen::Vector3d& values,
                                     const Pose2& world_T_curve) {
  PolynomialCurve2 curve;
  auto& c = curve.coefficients;
  switch (curve_class) {
    case CurveClass::Line:
      c.col(1) = Vec2(1.0, 0.0);
      break;
    case CurveClass::Parabola:
      c.col(1) = Vec2(0.0, 2.0 * values[0]);
      c.col(2) = Vec2(values[0], 0.0);
      break;
    case CurveClass::CubicalParabola:
      c.col(1) = Vec2(1.0, values[1]);
      c.col(3) = Vec2(0.0, values[0]);
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      c.col(1) = Vec2(0.0, curve_class == CurveClass::CubicSpline ? values[2] : 0.0);
      c.col(2) = Vec2(1.0, values[1]);
      c.col(3) = Vec2(0.0, values[0]);
      break;
    default:
      assert(false);
  }
  for (int power = 1; power <= 3; ++power) {
    c.col(power) = world_T_curve.rotate(c.col(power));
  }
  c.col(0) = world_T_curve.translation();
  return curve;
}

PolynomialCurve2 cubic(const Eigen::Vector4d& x, const Eigen::Vector4d& y) {
  PolynomialCurve2 curve;
  curve.coefficients.row(0) = x.transpose();
  curve.coefficients.row(1) = y.transpose();
  return curve;
}

/// Largest distance between the polynomials and their canonical form over [-2, 2].
double misplacement(const PolynomialCurve2& curve, const CanonicalCubic& canonical) {
  const PolynomialCurve2 back =
      polynomial_curve_of(canonical.curve_class, canonical.values, canonical.world_T_curve);
  double worst = 0.0;
  for (double t = -2.0; t <= 2.0; t += 0.125) {
    worst = std::max(worst, (back.position(canonical.canonical_t(t)) - curve.position(t)).norm());
  }
  return worst;
}

CanonicalCubic expect_class(CurveClass curve_class, const PolynomialCurve2& curve) {
  const CubicCanonicalisation result = canonicalise(curve);
  EXPECT_TRUE(result.curve.has_value()) << describe(result.degeneracy);
  if (!result.curve) {
    return {};
  }
  EXPECT_EQ(result.degeneracy, CubicDegeneracy::None);
  EXPECT_EQ(result.curve->curve_class, curve_class) << name_of(result.curve->curve_class);
  // The polynomials and the form are evaluated to a few epsilon of sizes of at most 100 here.
  EXPECT_LE(misplacement(curve, *result.curve), 1e-13);
  return *result.curve;
}

TEST(CanonicalCubic, Line) {
  const CanonicalCubic line = expect_class(CurveClass::Line, cubic({1, 3, 0, 0}, {2, -4, 0, 0}));
  EXPECT_DOUBLE_EQ(line.canonical_t.scale, 5.0);
  EXPECT_DOUBLE_EQ(line.world_T_curve.theta, std::atan2(-4.0, 3.0));
}

TEST(CanonicalCubic, ParabolaWithItsCubicTermsGone) {
  // (13) with a = 2 over t = 3u - 1, turned by 90 degrees.
  const CanonicalCubic parabola =
      expect_class(CurveClass::Parabola, cubic({4, -12, 0, 0}, {2, -12, 18, 0}));
  EXPECT_NEAR(parabola.values[0], 2.0, 1e-15);
  EXPECT_NEAR(parabola.world_T_curve.theta, 0.5 * kPi, 1e-15);
  EXPECT_NEAR(parabola.world_T_curve.x, 0.0, 1e-15);
  EXPECT_NEAR(parabola.world_T_curve.y, 0.0, 1e-15);
  EXPECT_NEAR(std::abs(parabola.canonical_t.scale), 3.0, 1e-14);
}

TEST(CanonicalCubic, CubicalParabolaWithAndWithoutQuadraticTerms) {
  // a2 = b2 = 0: already centred on its inflection.
  const CanonicalCubic centred =
      expect_class(CurveClass::CubicalParabola, cubic({0, 2, 0, 0}, {0, 1, 0, 8}));
  EXPECT_DOUBLE_EQ(centred.values[0], 1.0);
  EXPECT_DOUBLE_EQ(centred.values[1], 0.5);
  // Mirrored: a < 0, not a pose.
  const CanonicalCubic mirrored =
      expect_class(CurveClass::CubicalParabola, cubic({0, 2, 0, 0}, {0, -1, 0, -8}));
  EXPECT_DOUBLE_EQ(mirrored.values[0], -1.0);
  EXPECT_DOUBLE_EQ(mirrored.values[1], -0.5);
  // The quadratic term along the cubic one: a2 b3 - a3 b2 = 0.
  const CanonicalCubic shifted =
      expect_class(CurveClass::CubicalParabola, cubic({0, 2, 3, 1}, {0, 1, 6, 2}));
  EXPECT_NEAR(shifted.canonical_t.shift / shifted.canonical_t.scale, 1.0, 1e-15);
}

TEST(CanonicalCubic, B3IsZero) {
  // x cubic, y linear: the paper's arctan(a3 / b3) is +-pi/2.
  const CanonicalCubic cubical =
      expect_class(CurveClass::CubicalParabola, cubic({0, 1, 0, 4}, {0, 2, 0, 0}));
  EXPECT_NEAR(std::abs(cubical.world_T_curve.theta), 0.5 * kPi, 1e-15);
  EXPECT_NEAR(cubical.values[0], -0.5, 1e-15);  // x = 4 (y/2)^3 + ...: bends to the right
  expect_class(CurveClass::SemiCubicalParabola, cubic({0, 0, 0, 4}, {0, 0, 2, 0}));
  expect_class(CurveClass::CubicSpline, cubic({0, 1, 0, -4}, {0, 0, -2, 0}));
}

TEST(CanonicalCubic, SemiCubicalParabola) {
  const CanonicalCubic semi =
      expect_class(CurveClass::SemiCubicalParabola, cubic({5, 0, 4, 0}, {6, 0, 3, 16}));
  EXPECT_DOUBLE_EQ(semi.values[0], 2.0);
  EXPECT_DOUBLE_EQ(semi.values[1], 0.75);
  EXPECT_EQ(semi.values[2], 0.0);
  EXPECT_DOUBLE_EQ(semi.world_T_curve.x, 5.0);
  // The cusp away from t = 0: (t + 1)^2, (t + 1)^3.
  expect_class(CurveClass::SemiCubicalParabola, cubic({1, 2, 1, 0}, {1, 3, 3, 1}));
}

TEST(CanonicalCubic, NegativeC2TurnsByPi) {
  const CanonicalCubic spline =
      expect_class(CurveClass::CubicSpline, cubic({0, 0, -4, 0}, {0, 2, 0, 8}));
  EXPECT_NEAR(std::abs(spline.world_T_curve.theta), kPi, 1e-15);
  EXPECT_DOUBLE_EQ(spline.values[0], 1.0);
  EXPECT_DOUBLE_EQ(spline.values[2], 1.0);
  EXPECT_LT(spline.canonical_t.scale, 0.0);
}

TEST(CanonicalCubic, MirrorImageIsAnotherShape) {
  const CanonicalCubic one =
      expect_class(CurveClass::CubicSpline, cubic({0, 0, 1, 0}, {0, 2, 0.5, 3}));
  const CanonicalCubic mirrored =
      expect_class(CurveClass::CubicSpline, cubic({0, 0, 1, 0}, {0, -2, -0.5, -3}));
  EXPECT_DOUBLE_EQ(one.values[0], mirrored.values[0]);
  EXPECT_DOUBLE_EQ(one.values[1], -mirrored.values[1]);
  EXPECT_DOUBLE_EQ(one.values[2], mirrored.values[2]);
}

void expect_degenerate(CubicDegeneracy degeneracy, const PolynomialCurve2& curve) {
  const CubicCanonicalisation result = canonicalise(curve);
  EXPECT_FALSE(result.curve.has_value());
  EXPECT_EQ(result.degeneracy, degeneracy) << describe(result.degeneracy);
}

TEST(CanonicalCubic, Degenerate) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_degenerate(CubicDegeneracy::Point, cubic({3, 0, 0, 0}, {4, 0, 0, 0}));
  expect_degenerate(CubicDegeneracy::HalfLine, cubic({0, 0, 1, 0}, {0, 0, 0, 0}));
  expect_degenerate(CubicDegeneracy::HalfLine, cubic({0, 3, 1, 0}, {5, 6, 2, 0}));
  expect_degenerate(CubicDegeneracy::UnevenLine, cubic({0, 0, 0, 0}, {1, 2, 3, 4}));
  expect_degenerate(CubicDegeneracy::UnevenLine, cubic({0, 1, 2, 3}, {7, -2, -4, -6}));
  expect_degenerate(CubicDegeneracy::NotFinite, cubic({0, 1, nan, 0}, {0, 0, 0, 1}));
  expect_degenerate(CubicDegeneracy::NotFinite,
                    cubic({0, 1, 0, 0}, {0, 0, 0, std::numeric_limits<double>::infinity()}));
  expect_degenerate(CubicDegeneracy::OutOfRange, cubic({0, 1e-200, 0, 0}, {0, 0, 0, 1}));
}

TEST(CanonicalCubic, DegenerateOnesSayWhereTheyLie) {
  // The half-line from (-1, 1) along (3, 4): (t + 1)^2 times it.
  const Pose2 half = canonicalise(cubic({2, 6, 3, 0}, {5, 8, 4, 0})).world_T_curve;
  EXPECT_NEAR(half.x, -1.0, 1e-15);
  EXPECT_NEAR(half.y, 1.0, 1e-15);
  EXPECT_NEAR(half.theta, std::atan2(4.0, 3.0), 1e-15);
  EXPECT_EQ(canonicalise(cubic({3, 0, 0, 0}, {4, 0, 0, 0})).world_T_curve.y, 4.0);
  const Pose2 uneven = canonicalise(cubic({1, 0, 0, -2}, {0, 0, 0, 0})).world_T_curve;
  EXPECT_NEAR(std::abs(uneven.theta), kPi, 1e-15);
}

TEST(CanonicalCubic, ToleranceIsADistanceOverTheRange) {
  // Over |t| <= 2 the cubic term moves points by at most 8e-3.
  const PolynomialCurve2 curve = cubic({0, 0, 1, 0}, {0, 2, 0, 1e-3});
  EXPECT_EQ(canonicalise(curve).curve->curve_class, CurveClass::CubicSpline);
  EXPECT_EQ(canonicalise(curve, {7.9e-3, -2.0, 2.0}).curve->curve_class, CurveClass::CubicSpline);
  EXPECT_EQ(canonicalise(curve, {8.1e-3, -2.0, 2.0}).curve->curve_class, CurveClass::Parabola);
  // Each limit of the spline: c (cusp), the quadratic term, everything but a line.
  const auto class_within = [](const PolynomialCurve2& of, double distance) {
    return canonicalise(of, {distance, -1.0, 1.0}).curve->curve_class;
  };
  const PolynomialCurve2 blunt = cubic({0, 0, 1, 0}, {0, 1e-4, 0, 1});
  EXPECT_EQ(class_within(blunt, 0.9e-4), CurveClass::CubicSpline);
  EXPECT_EQ(class_within(blunt, 1.1e-4), CurveClass::SemiCubicalParabola);
  const PolynomialCurve2 skew = cubic({0, 1, 1e-4, 0}, {0, 0, 0, 1});
  EXPECT_EQ(class_within(skew, 0.9e-4), CurveClass::CubicSpline);
  EXPECT_EQ(class_within(skew, 1.1e-4), CurveClass::CubicalParabola);
  const PolynomialCurve2 flat = cubic({0, 1, 0, 0}, {0, 0, 1e-4, 0.5e-4});
  EXPECT_EQ(class_within(flat, 1e-5), CurveClass::CubicalParabola);
  EXPECT_EQ(class_within(flat, 1.1e-4), CurveClass::Line);
}

TEST(CanonicalCubic, ToleranceActsAboutTheMiddleOfTheRange) {
  // 1e-6 t^3 is no small term near t = 1000, but its cube about 1000 is.
  const PolynomialCurve2 curve = cubic({0, 1, 0, 0}, {0, 0, 0, 1e-6});
  const CubicCanonicalisation result = canonicalise(curve, {1e-5, 999.0, 1001.0});
  ASSERT_TRUE(result.curve.has_value());
  EXPECT_EQ(result.curve->curve_class, CurveClass::Parabola);
  const PolynomialCurve2 back =
      polynomial_curve_of(CurveClass::Parabola, result.curve->values, result.curve->world_T_curve);
  for (double t = 999.0; t <= 1001.0; t += 0.25) {
    EXPECT_LE((back.position(result.curve->canonical_t(t)) - curve.position(t)).norm(), 1.1e-6);
  }
}

TEST(CanonicalCubic, ForcedClasses) {
  const PolynomialCurve2 curve = cubic({0, 1, 1e-20, 0}, {0, 1, 0, 1});
  EXPECT_EQ(canonicalise(curve).curve->curve_class, CurveClass::CubicSpline);
  const CubicCanonicalisation cubical = canonicalise_as(CurveClass::CubicalParabola, curve);
  ASSERT_TRUE(cubical.curve.has_value());
  EXPECT_EQ(cubical.curve->values[0], 1.0);
  EXPECT_EQ(canonicalise_as(CurveClass::Line, curve).curve->canonical_t.scale, std::sqrt(2.0));
  EXPECT_EQ(canonicalise_as(CurveClass::Parabola, cubic({0, 1, 0, 0}, {0, 0, 0, 1})).degeneracy,
            CubicDegeneracy::OutsideClass);
  const PolynomialCurve2 cusp = cubic({0, 0, 1, 0}, {0, 0, 0, 1});
  EXPECT_EQ(canonicalise_as(CurveClass::CubicSpline, cusp).degeneracy,
            CubicDegeneracy::OutsideClass);
  EXPECT_EQ(canonicalise_as(CurveClass::CubicalParabola, cusp).degeneracy,
            CubicDegeneracy::OutsideClass);
}

TEST(CubicSpline, BendsAtItsVertexByC) {
  for (const double radius : {1e-4, 0.03, 7.0}) {
    const CubicSpline spline{12.0, -0.4, CubicSpline::c_of_bend(radius)};
    EXPECT_NEAR(spline.geometry(0.0).kappa, -1.0 / radius, 1e-14 / radius);
  }
}

}  // namespace
}  // namespace palpate
