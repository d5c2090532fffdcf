#include "core/numerics/polynomials/orthogonal_polynomials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct WeightedPoints {
  std::vector<double> x, w, y;
};

WeightedPoints random_points(std::size_t n) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  WeightedPoints points;
  for (std::size_t i = 0; i < n; ++i) {
    points.x.push_back(2.0 * uniform(rng) - 1.0);
    points.w.push_back(0.5 + uniform(rng));
    points.y.push_back(uniform(rng));
  }
  return points;
}

TEST(OrthogonalPolynomials, ReproducePolynomialsOfTheirDegree) {
  WeightedPoints points = random_points(40);
  const auto polynomial = [](double x) { return 1.0 - 2.0 * x + 0.5 * x * x * x; };
  const auto derivative = [](double x) { return -2.0 + 1.5 * x * x; };
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    points.y[i] = polynomial(points.x[i]);
  }
  const OrthogonalPolynomials fit(points.x, points.w, points.y, 5);
  EXPECT_GT(fit.residual_sum(2), 1e-3);
  EXPECT_LT(fit.residual_sum(3), 1e-28);
  for (const double x : {-1.0, -0.3, 0.0, 0.8}) {
    EXPECT_NEAR(fit.evaluate(x, 3).value, polynomial(x), 1e-14);
    EXPECT_NEAR(fit.evaluate(x, 5).derivative, derivative(x), 1e-12);
  }
}

TEST(OrthogonalPolynomials, GaussRuleIntegratesToTwiceItsDegreePlusOne) {
  const WeightedPoints points = random_points(60);
  const OrthogonalPolynomials fit(points.x, points.w, points.y, 9);
  for (int degree = 1; degree <= 9; ++degree) {
    const auto rule = fit.gauss_rule(degree);
    ASSERT_EQ(rule.size(), static_cast<std::size_t>(degree + 1));
    for (int power = 0; power <= 2 * degree + 1; ++power) {
      double exact = 0.0;
      for (std::size_t i = 0; i < points.x.size(); ++i) {
        exact += points.w[i] * std::pow(points.x[i], power);
      }
      double quadrature = 0.0;
      for (const auto& node : rule) {
        EXPECT_GT(node.weight, 0.0);
        quadrature += node.weight * std::pow(node.x, power);
      }
      EXPECT_NEAR(quadrature, exact, 1e-12 * 60.0) << degree << " " << power;
    }
  }
}

TEST(OrthogonalPolynomials, ResidualPlusProjectionIsTheWhole) {
  // Pythagoras: sum w (y - q)^2 = residual + sum w (fit - q)^2 for any polynomial q of the degree,
  // and the Gauss rule gives the second sum. This is what lets a dozen points stand for hundreds.
  const WeightedPoints points = random_points(80);
  const OrthogonalPolynomials fit(points.x, points.w, points.y, 6);
  const auto q = [](double x) { return 0.3 + x - 0.7 * x * x * x * x; };
  double whole = 0.0;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    whole += points.w[i] * std::pow(points.y[i] - q(points.x[i]), 2);
  }
  double reduced = fit.residual_sum(6);
  for (const auto& node : fit.gauss_rule(6)) {
    reduced += node.weight * std::pow(fit.evaluate(node.x, 6).value - q(node.x), 2);
  }
  EXPECT_NEAR(reduced, whole, 1e-12 * whole);
}

}  // namespace
}  // namespace palpate
