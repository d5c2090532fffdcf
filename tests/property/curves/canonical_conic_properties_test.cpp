// Thousands of random conics at random poses and sizes: conversion to the canonical form and back.
#include "core/curves/algebraic/canonical_conic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/property/curves/random_curves.h"
#include "tests/support/conic_equation.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr CurveClass kClasses[] = {CurveClass::Line, CurveClass::Circle, CurveClass::Ellipse,
                                   CurveClass::Parabola, CurveClass::Hyperbola};

TEST(CanonicalConicProperties, EveryCurveComesBackFromItsEquation) {
  std::mt19937_64 rng = test::test_rng();
  for (int trial = 0; trial < test::stress_count(2000); ++trial) {
    for (const CurveClass curve_class : kClasses) {
      const RandomCurve random = random_curve(curve_class, rng);
      // In any unit of length and with any common factor.
      const double unit = std::pow(10.0, uniform(rng, -6.0, 6.0));
      const Eigen::Vector3d values = unit * random.values;
      const Pose2 pose{unit * uniform(rng, -3.0, 3.0), unit * uniform(rng, -3.0, 3.0),
                       uniform(rng, -kPi, kPi)};
      const double factor = random_sign(rng) * std::pow(10.0, uniform(rng, -9.0, 9.0));
      const ConicCanonicalisation back =
          canonicalise(factor * test::conic_of(curve_class, values, pose));
      ASSERT_TRUE(back.curve.has_value())
          << name_of(curve_class) << " " << describe(back.degeneracy);
      ASSERT_EQ(back.curve->curve_class, curve_class) << values.transpose() << " unit " << unit;
      // Coefficients are rounded relative to their terms, those of a pose three sizes away. The
      // squares of the semi-axes (0.05 to 3 units) are differences of such terms.
      const double bound = 1e3 * 400.0 * std::numeric_limits<double>::epsilon();
      for (Eigen::Index k = 0; k < 2; ++k) {
        EXPECT_LE(std::abs(back.curve->values[k] - values[k]), bound * unit)
            << name_of(curve_class);
      }
      if (curve_class == CurveClass::Line) {
        // The same line: its point nearest to the origin lies on both.
        EXPECT_LE(std::abs(pose.to_local(back.curve->world_T_curve.translation()).y()),
                  bound * unit);
        EXPECT_LE(std::abs(std::sin(back.curve->world_T_curve.theta - pose.theta)), bound);
        continue;
      }
      const Vec2 centre = back.curve->world_T_curve.translation() - pose.translation();
      EXPECT_LE(centre.norm(), bound * unit) << name_of(curve_class) << values.transpose() / unit;
      if (curve_class != CurveClass::Circle) {
        const double turn = back.curve->world_T_curve.theta - pose.theta;
        const double period = curve_class == CurveClass::Parabola ? 2.0 * kPi : kPi;
        // The direction of the axes is the less certain, the closer the two eigenvalues are.
        const double alike =
            curve_class == CurveClass::Ellipse ? 1.0 - std::pow(values[1] / values[0], 2) : 1.0;
        EXPECT_LE(std::abs(std::remainder(turn, period)), bound / alike) << name_of(curve_class);
      }
    }
  }
}

TEST(CanonicalConicProperties, PointsOfTheCurveSatisfyItsEquation) {
  std::mt19937_64 rng = test::test_rng();
  for (int trial = 0; trial < test::stress_count(2000); ++trial) {
    for (const CurveClass curve_class : kClasses) {
      const RandomCurve random = random_curve(curve_class, rng);
      const Pose2 pose{uniform(rng, -3.0, 3.0), uniform(rng, -3.0, 3.0), uniform(rng, -kPi, kPi)};
      const ConicCoefficients q = test::conic_of(curve_class, random.values, pose);
      const Vec2 p = pose * position(random.curve, random.random_t(rng));
      Eigen::Matrix<double, 6, 1> terms;
      terms << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1.0;
      terms = terms.cwiseProduct(q);
      // Rounding of the coefficients and of the point, relative to the sizes of the terms and of
      // the pose: about 100 units in the last place.
      const double size = terms.cwiseAbs().sum() + q.cwiseAbs().maxCoeff() * 100.0;
      EXPECT_LE(std::abs(terms.sum()), 100.0 * std::numeric_limits<double>::epsilon() * size)
          << name_of(curve_class);
    }
  }
}

TEST(CanonicalConicProperties, ThroughTheParabolaTheClassChangesWhereRoundingLosesTheDifference) {
  // b^2 = a p, a -> infinity: an ellipse seen from its vertex, with the quadratic part (p / a, 1).
  for (int exponent = 0; exponent <= 18; ++exponent) {
    const double small = std::pow(10.0, -exponent);
    ConicCoefficients q;
    q << small, 0.0, 1.0, -2.0, 0.0, 0.0;
    const auto ellipse = canonicalise(q);
    q[0] = -small;
    const auto hyperbola = canonicalise(q);
    ASSERT_TRUE(ellipse.curve && hyperbola.curve);
    const bool lost = small <= 16.0 * std::numeric_limits<double>::epsilon();
    const CurveClass round = exponent == 0 ? CurveClass::Circle : CurveClass::Ellipse;
    EXPECT_EQ(ellipse.curve->curve_class, lost ? CurveClass::Parabola : round) << exponent;
    EXPECT_EQ(hyperbola.curve->curve_class, lost ? CurveClass::Parabola : CurveClass::Hyperbola)
        << exponent;
  }
}

}  // namespace
}  // namespace palpate
