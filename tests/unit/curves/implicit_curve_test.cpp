// Appendix C: curvature and its derivative from an equation alone.
#include "core/curves/algebraic/implicit_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/curves/algebraic/canonical_conic.h"
#include "tests/property/curves/random_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

BivariatePolynomial equation_of(const ConicCoefficients& q) {
  BivariatePolynomial f(2);
  f.coefficient(2, 0) = q[0];
  f.coefficient(1, 1) = q[1];
  f.coefficient(0, 2) = q[2];
  f.coefficient(1, 0) = q[3];
  f.coefficient(0, 1) = q[4];
  f.coefficient(0, 0) = q[5];
  return f;
}

TEST(ImplicitCurve, AgreesWithTheParametricGeometryOfEveryConicAtAnyPose) {
  std::mt19937_64 rng = test::test_rng();
  for (int trial = 0; trial < 2000; ++trial) {
    for (const CurveClass curve_class : {CurveClass::Line, CurveClass::Circle, CurveClass::Ellipse,
                                         CurveClass::Parabola, CurveClass::Hyperbola}) {
      const RandomCurve random = random_curve(curve_class, rng);
      const Pose2 pose{uniform(rng, -2.0, 2.0), uniform(rng, -2.0, 2.0), uniform(rng, -kPi, kPi)};
      const double t = random.random_t(rng);
      const LocalGeometry expected = geometry(random.curve, t);
      const auto found = implicit_geometry(equation_of(conic_of(curve_class, random.values, pose)),
                                           pose * position(random.curve, t));
      ASSERT_TRUE(found.has_value());
      const double turn = found->tangent_angle - expected.tangent_angle - pose.theta;
      const double sign = std::cos(turn) > 0.0 ? 1.0 : -1.0;
      // Semi-axes of 0.05 to 3 and poses of 2: quadratic terms of up to 400 times what is left of
      // them, once in the gradient and three times in kappa_s.
      EXPECT_LE(std::abs(std::sin(turn)), 1e-11) << name_of(curve_class);
      const double size = 1.0 + std::abs(expected.kappa);
      EXPECT_NEAR(sign * found->kappa / size, expected.kappa / size, 1e-10) << name_of(curve_class);
      const double size_s = 1.0 + std::abs(expected.kappa_s) + expected.kappa * expected.kappa;
      EXPECT_NEAR(found->kappa_s / size_s, expected.kappa_s / size_s, 1e-9) << name_of(curve_class);
    }
  }
}

TEST(ImplicitCurve, OfHighDegree) {
  // The superellipse x^8 + y^8 = 1 at (2^(-1/8), 2^(-1/8)), where its symmetry makes kappa_s = 0:
  // kappa = (n - 1) 2^(1/n) / sqrt(2) with n = 8 (from y'' of the graph there).
  BivariatePolynomial f(8);
  f.coefficient(8, 0) = f.coefficient(0, 8) = 1.0;
  f.coefficient(0, 0) = -1.0;
  const double c = std::pow(2.0, -1.0 / 8.0);
  const auto local = implicit_geometry(f, {c, c});
  ASSERT_TRUE(local.has_value());
  EXPECT_NEAR(std::abs(local->kappa), 7.0 * std::pow(2.0, 1.0 / 8.0) / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(local->kappa_s, 0.0, 1e-11);
}

TEST(ImplicitCurve, ScaleAndOriginDoNotMatter) {
  // A circle of 1e-6 m, 1e6 m away.
  const Vec2 centre(1e6, -1e6);
  BivariatePolynomial f(2, centre, 1e-6);
  f.coefficient(2, 0) = f.coefficient(0, 2) = 1.0;
  f.coefficient(0, 0) = -1.0;
  // There a double resolves 1e-10 m, a ten-thousandth of the radius.
  const auto local = implicit_geometry(f, centre + Vec2(1e-6, 0.0));
  ASSERT_TRUE(local.has_value());
  EXPECT_NEAR(local->kappa * 1e-6, -1.0, 2e-4);  // clockwise: the gradient points outwards
}

TEST(ImplicitCurve, SingularPointsAreRefused) {
  BivariatePolynomial cusp(3);  // y^2 = x^3
  cusp.coefficient(0, 2) = 1.0;
  cusp.coefficient(3, 0) = -1.0;
  EXPECT_FALSE(implicit_geometry(cusp, {0.0, 0.0}).has_value());
  EXPECT_TRUE(implicit_geometry(cusp, {1.0, 1.0}).has_value());
  BivariatePolynomial node(2, {0.0, 0.0});  // (x - 0.1)^2 = (y - 0.3)^2 at its crossing, rounded
  node.coefficient(2, 0) = 1.0;
  node.coefficient(0, 2) = -1.0;
  node.coefficient(1, 0) = -0.2;
  node.coefficient(0, 1) = 0.6;
  node.coefficient(0, 0) = 0.01 - 0.09;
  EXPECT_FALSE(implicit_geometry(node, {0.1, 0.3}).has_value());
}

}  // namespace
}  // namespace palpate
