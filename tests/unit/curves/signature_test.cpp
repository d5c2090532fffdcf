// Signature and semi-signature curves.
#include "tests/support/signature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/property/curves/random_curves.h"
#include "tests/support/reference_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

TEST(Signature, SamplesEveryClassAndLeavesTheCuspOut) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    const RandomCurve random = random_curve(curve_class, rng);
    const auto points = test::signature_curve(random.curve, -1.0, 1.0, 201);
    // t = 0 is the cusp of a semi-cubical parabola.
    EXPECT_EQ(points.size(), curve_class == CurveClass::SemiCubicalParabola ? 200U : 201U);
    for (const test::SignaturePoint& point : points) {
      const LocalGeometry local = geometry(random.curve, point.t);
      EXPECT_EQ(point.kappa, local.kappa);
      EXPECT_EQ(point.kappa_s, local.kappa_s);
      EXPECT_EQ(point.slope(), std::tan(local.tangent_angle));
    }
  }
}

TEST(Signature, ClosedEquationsOfTheConicsHoldAtEveryReferencePoint) {
  int points = 0;
  for (const test::ReferenceCurve& reference : test::reference_curves()) {
    const auto curve = make_curve(reference.curve_class, {reference.a, reference.b, reference.c});
    const auto signature = curve ? test::conic_signature(*curve) : std::nullopt;
    if (!signature) {
      continue;
    }
    for (const test::ReferencePoint& point : reference.points) {
      // Three terms, each a few cube roots and quotients of doubles; kappa_s / kappa^2 is rounded
      // where it is small beside 1.
      EXPECT_LE(std::abs(signature->residual(point.kappa, point.kappa_s)), 1e-14)
          << name_of(reference.curve_class) << " t " << point.t;
      // On one curve only: a hundredth more curvature is off it.
      if (reference.curve_class != CurveClass::Circle) {
        EXPECT_GT(std::abs(signature->residual(1.01 * point.kappa, point.kappa_s)), 1e-6);
      }
      ++points;
    }
  }
  EXPECT_GT(points, 100);
}

TEST(Signature, TravelledTheOtherWayTheCurveIsTheSame) {
  std::mt19937_64 rng = test::test_rng();
  for (int trial = 0; trial < 1000; ++trial) {
    for (const CurveClass curve_class :
         {CurveClass::Circle, CurveClass::Ellipse, CurveClass::Parabola, CurveClass::Hyperbola}) {
      const RandomCurve random = random_curve(curve_class, rng);
      const LocalGeometry local = reversed(geometry(random.curve, random.random_t(rng)));
      EXPECT_LE(std::abs(test::conic_signature(random.curve)->residual(local.kappa, local.kappa_s)),
                1e-13);
    }
  }
}

TEST(Signature, HasNoClosedEquationForTheOthersAndNoNaN) {
  EXPECT_FALSE(test::conic_signature(Line{}).has_value());
  std::mt19937_64 rng = test::test_rng();
  EXPECT_FALSE(test::conic_signature(random_curve(CurveClass::CubicSpline, rng).curve).has_value());
  const auto ellipse = test::conic_signature(random_curve(CurveClass::Ellipse, rng).curve);
  EXPECT_EQ(ellipse->residual(0.0, 1.0), 1.0);
  EXPECT_EQ(ellipse->residual(1e-200, 1e200), 1.0);
}

}  // namespace
}  // namespace palpate
