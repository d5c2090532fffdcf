// The general conic (10) on hand-made equations: every class, every degenerate case.
#include "core/curves/algebraic/canonical_conic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

ConicCoefficients conic(double xx, double xy, double yy, double x, double y, double one) {
  ConicCoefficients q;
  q << xx, xy, yy, x, y, one;
  return q;
}

CanonicalConic expect_class(CurveClass curve_class, const ConicCoefficients& q) {
  const ConicCanonicalisation result = canonicalise(q);
  EXPECT_TRUE(result.curve.has_value()) << describe(result.degeneracy);
  if (!result.curve) {
    return {};
  }
  EXPECT_EQ(result.curve->curve_class, curve_class) << name_of(result.curve->curve_class);
  return *result.curve;
}

void expect_degenerate(ConicDegeneracy degeneracy, const ConicCoefficients& q) {
  const ConicCanonicalisation result = canonicalise(q);
  EXPECT_FALSE(result.curve.has_value());
  EXPECT_EQ(result.degeneracy, degeneracy) << describe(result.degeneracy);
}

TEST(CanonicalConic, Line) {
  const CanonicalConic line = expect_class(CurveClass::Line, conic(0, 0, 0, 3, 4, -10));
  // 3 x + 4 y = 10 lies 2 from the origin, at (1.2, 1.6).
  EXPECT_DOUBLE_EQ(line.world_T_curve.x, 1.2);
  EXPECT_DOUBLE_EQ(line.world_T_curve.y, 1.6);
  EXPECT_NEAR(std::tan(line.world_T_curve.theta), -0.75, 1e-15);
}

TEST(CanonicalConic, Circle) {
  // (x - 1)^2 + (y + 2)^2 = 9, times -2.
  const CanonicalConic circle = expect_class(CurveClass::Circle, conic(-2, 0, -2, 4, -8, 8));
  EXPECT_DOUBLE_EQ(circle.values[0], 3.0);
  EXPECT_DOUBLE_EQ(circle.world_T_curve.x, 1.0);
  EXPECT_DOUBLE_EQ(circle.world_T_curve.y, -2.0);
}

TEST(CanonicalConic, EllipseWithItsLongAxisAcross) {
  // (x - 3)^2 + (y - 1)^2 / 4 = 1
  const CanonicalConic ellipse = expect_class(CurveClass::Ellipse, conic(4, 0, 1, -24, -2, 33));
  EXPECT_DOUBLE_EQ(ellipse.values[0], 2.0);
  EXPECT_DOUBLE_EQ(ellipse.values[1], 1.0);
  EXPECT_NEAR(std::abs(ellipse.world_T_curve.theta), 0.5 * kPi, 1e-15);
  EXPECT_DOUBLE_EQ(ellipse.world_T_curve.x, 3.0);
}

TEST(CanonicalConic, ParabolasOpenTheRightWay) {
  // y^2 = 8 x, x^2 = -8 y
  const CanonicalConic right = expect_class(CurveClass::Parabola, conic(0, 0, 1, -8, 0, 0));
  EXPECT_DOUBLE_EQ(right.values[0], 2.0);
  EXPECT_NEAR(right.world_T_curve.theta, 0.0, 1e-15);
  const CanonicalConic down = expect_class(CurveClass::Parabola, conic(1, 0, 0, 0, 8, 0));
  EXPECT_NEAR(down.world_T_curve.theta, -0.5 * kPi, 1e-15);
}

TEST(CanonicalConic, HyperbolaAndItsConjugate) {
  // x^2 / 4 - y^2 = 1, and with its right side negated
  const CanonicalConic along_x = expect_class(CurveClass::Hyperbola, conic(1, 0, -4, 0, 0, -4));
  EXPECT_DOUBLE_EQ(along_x.values[0], 2.0);
  EXPECT_DOUBLE_EQ(along_x.values[1], 1.0);
  const CanonicalConic along_y = expect_class(CurveClass::Hyperbola, conic(1, 0, -4, 0, 0, 4));
  EXPECT_DOUBLE_EQ(along_y.values[0], 1.0);
  EXPECT_DOUBLE_EQ(along_y.values[1], 2.0);
  EXPECT_NEAR(std::abs(along_y.world_T_curve.theta), 0.5 * kPi, 1e-15);
  const CanonicalConic rectangular = expect_class(CurveClass::Hyperbola, conic(0, 1, 0, 0, 0, -1));
  EXPECT_DOUBLE_EQ(rectangular.values[0], std::sqrt(2.0));
  EXPECT_NEAR(rectangular.world_T_curve.theta, 0.25 * kPi, 1e-15);
}

TEST(CanonicalConic, EveryDegenerateCaseIsNamed) {
  expect_degenerate(ConicDegeneracy::NotFinite,
                    conic(1, 0, 1, std::numeric_limits<double>::quiet_NaN(), 0, -1));
  expect_degenerate(ConicDegeneracy::NoEquation, conic(0, 0, 0, 0, 0, 1));
  expect_degenerate(ConicDegeneracy::NoEquation, conic(0, 0, 0, 0, 0, 0));
  expect_degenerate(ConicDegeneracy::Imaginary, conic(1, 0, 2, 0, 0, 1));
  expect_degenerate(ConicDegeneracy::Imaginary, conic(1, 2, 1, 0, 0, 1));  // (x + y)^2 = -1
  expect_degenerate(ConicDegeneracy::Point, conic(1, 0, 2, -2, -8, 9));
  expect_degenerate(ConicDegeneracy::CrossingLines, conic(1, 0, -1, -2, 4, -3));
  expect_degenerate(ConicDegeneracy::ParallelLines, conic(1, 2, 1, 0, 0, -1));
  expect_degenerate(ConicDegeneracy::DoubleLine, conic(1, 2, 1, 2, 2, 1));
}

TEST(CanonicalConic, TheClassDemandedAndNotMetIsRefused) {
  const ConicCoefficients ellipse = conic(1, 0, 2, 0, 0, -1);
  EXPECT_TRUE(canonicalise_as(CurveClass::Ellipse, ellipse).has_value());
  EXPECT_FALSE(canonicalise_as(CurveClass::Hyperbola, ellipse).has_value());
  EXPECT_FALSE(canonicalise_as(CurveClass::Ellipse, conic(1, 0, 2, 0, 0, 1)).has_value());
}

}  // namespace
}  // namespace palpate
