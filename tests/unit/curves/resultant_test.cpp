// Appendix A: Sylvester's matrix, the resultant, and the equation of a polynomial curve.
#include "core/curves/algebraic/resultant.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "core/curves/algebraic/canonical_cubic.h"
#include "core/curves/algebraic/implicit_curve.h"
#include "tests/support/reference_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// c (t - r0) (t - r1) ..., constant first.
std::vector<double> with_roots(double c, const std::vector<double>& roots) {
  std::vector<double> p{c};
  for (const double root : roots) {
    p.insert(p.begin(), 0.0);
    for (std::size_t k = 0; k + 1 < p.size(); ++k) {
      p[k] -= root * p[k + 1];
    }
  }
  return p;
}

TEST(Resultant, OfHandMadePolynomials) {
  // Res(t^2 - 1, t - 2) = (2^2 - 1) (-1)^(...): p(2) = 3.
  EXPECT_NEAR(resultant(std::array{-1.0, 0.0, 1.0}, std::array{-2.0, 1.0}).value(), 3.0, 1e-14);
  EXPECT_NEAR(resultant(std::array{-2.0, 1.0}, std::array{-1.0, 0.0, 1.0}).value(), 3.0, 1e-14);
  // With a constant c: c^m.
  EXPECT_NEAR(resultant(std::array{1.0, 2.0, 3.0}, std::array{5.0}).value(), 25.0, 1e-13);
  EXPECT_EQ(resultant(std::array{5.0}, std::array{7.0}).value(), 1.0);
  // Leading zeros do not count.
  EXPECT_NEAR(resultant(std::array{-1.0, 0.0, 1.0, 0.0}, std::array{-2.0, 1.0, 0.0}).value(), 3.0,
              1e-14);
}

TEST(Resultant, IsTheProductOfRootDifferencesAndTheDeterminant) {
  // a^n b^m prod (r_i - s_j), over polynomials whose coefficients differ in size by many decades.
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> root(-2.0, 2.0);
  std::uniform_real_distribution<double> exponent(-40.0, 40.0);
  std::uniform_int_distribution<std::size_t> degree(1, 5);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<double> r(degree(rng));
    std::vector<double> s(degree(rng));
    for (double& x : r) x = root(rng);
    for (double& x : s) x = root(rng);
    const double a = std::pow(10.0, exponent(rng));
    const double b = -std::pow(10.0, exponent(rng));
    double log_modulus =
        static_cast<double>(s.size()) * std::log(a) + static_cast<double>(r.size()) * std::log(-b);
    double sign = r.size() % 2 == 1 ? -1.0 : 1.0;
    double nearest = 1.0;
    for (const double x : r) {
      for (const double y : s) {
        log_modulus += std::log(std::abs(x - y));
        sign *= x < y ? -1.0 : 1.0;
        nearest = std::min(nearest, std::abs(x - y));
      }
    }
    if (nearest < 1e-2) {
      continue;  // conditioned by the gap to the power of multiplicity: no fixed bound
    }
    const Resultant found = resultant(with_roots(a, r), with_roots(b, s));
    EXPECT_EQ(found.common_roots, 0) << trial;
    EXPECT_EQ(found.sign, sign) << trial;
    EXPECT_NEAR(found.log_modulus, log_modulus, 1e-6) << trial;
    if (std::abs(log_modulus) < 200.0) {
      const double determinant =
          sylvester_matrix(with_roots(1.0, r), with_roots(-1.0, s)).determinant();
      EXPECT_EQ(found.sign, std::copysign(1.0, determinant));
    }
  }
}

TEST(Resultant, CountsCommonRoots) {
  const auto p = with_roots(3.0, {0.5, -1.25, 2.0});
  EXPECT_EQ(resultant(p, with_roots(1.0, {0.25, 1.0})).common_roots, 0);
  EXPECT_EQ(resultant(p, with_roots(1.0, {0.5, 1.0})).common_roots, 1);
  EXPECT_EQ(resultant(p, with_roots(1.0, {0.5, 2.0})).common_roots, 2);
  EXPECT_EQ(resultant(p, p).common_roots, 3);
  EXPECT_EQ(resultant(p, p).value(), 0.0);
}

TEST(ImplicitEquation, OfTheCanonicalForms) {
  // (a t^2, 2 a t): y^2 = 4 a x.
  PolynomialCurve2 parabola;
  parabola.coefficients << 0, 0, 2, 0, 0, 4, 0, 0;
  const BivariatePolynomial f = implicit_equation(parabola);
  EXPECT_EQ(f.degree(), 2);
  const double ratio =
      f.coefficient(1, 0) / f.scale() / (f.coefficient(0, 2) / f.scale() / f.scale());
  EXPECT_DOUBLE_EQ(ratio, -8.0);
  EXPECT_EQ(f.coefficient(2, 0), 0.0);
  EXPECT_EQ(f.coefficient(1, 1), 0.0);
}

/// Class by class: the implicit equation's geometry is the parametric one's at the 50-digit points.
TEST(ImplicitEquation, GivesTheReferenceCurvatures) {
  int compared = 0;
  for (const test::ReferenceCurve& reference : test::reference_curves()) {
    const CurveClass curve_class = reference.curve_class;
    if (curve_class != CurveClass::Parabola && curve_class != CurveClass::CubicalParabola &&
        curve_class != CurveClass::SemiCubicalParabola && curve_class != CurveClass::CubicSpline) {
      continue;
    }
    Eigen::Vector3d values(reference.a, reference.b, reference.c);
    if (curve_class == CurveClass::CubicalParabola) {
      values = {reference.a, reference.c, 0.0};
    }
    const PolynomialCurve2 curve = polynomial_curve_of(curve_class, values, Pose2{});
    const BivariatePolynomial f = implicit_equation(curve);
    for (const test::ReferencePoint& point : reference.points) {
      const Vec2 p(point.x, point.y);
      const PlaneJet jet = f.jet(p);
      EXPECT_LE(std::abs(jet.f), 1e-13 * jet.size) << name_of(curve_class);
      const auto local = implicit_geometry(f, p);
      if (!local) {
        continue;
      }
      // The point is rounded, and the level line through it is another curve: relative errors are
      // magnified by the terms' size over the gradient. Beyond 1e3 nothing is compared.
      const double magnified = jet.gradient_size / jet.gradient.norm();
      if (magnified > 1e3) {
        continue;
      }
      ++compared;
      const double sign = std::cos(local->tangent_angle - point.tangent_angle) > 0.0 ? 1.0 : -1.0;
      const double size = std::abs(point.kappa) + std::sqrt(std::abs(point.kappa_s)) + 1e-3;
      const double bound = 1e-10 * magnified;
      EXPECT_NEAR(sign * local->kappa / size, point.kappa / size, bound) << name_of(curve_class);
      EXPECT_NEAR(local->kappa_s / (size * size), point.kappa_s / (size * size), bound)
          << name_of(curve_class) << " t " << point.t;
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace palpate
