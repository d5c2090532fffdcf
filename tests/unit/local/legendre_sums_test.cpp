// Normal equations from one sum a degree are those of the products themselves.
#include "core/numerics/polynomials/legendre_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "core/numerics/polynomials/legendre_fit.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

TEST(ProductCoefficient, MakesAProductASum) {
  for (const double u : {-1.0, -0.73, 0.0, 0.2, 0.999, 1.0}) {
    const LegendreVector<19> p = legendre<19>(u);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 11; ++j) {
        double sum = 0.0;
        double whole = 0.0;
        for (int r = 0; r <= std::min(i, j); ++r) {
          const double coefficient = product_coefficient(i, j, r);
          EXPECT_GE(coefficient, 0.0);
          whole += coefficient;
          sum += coefficient * p[i + j - 2 * r];
        }
        // A dozen operations on values of at most 1, and as many of the recurrence.
        EXPECT_NEAR(sum, p[i] * p[j], 64 * std::numeric_limits<double>::epsilon());
        EXPECT_NEAR(whole, 1.0, 64 * std::numeric_limits<double>::epsilon());
      }
    }
  }
}

TEST(LegendreSums, AreTheSumsOfTheProducts) {
  constexpr int kPoints = 60;
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> u;
  std::vector<double> v;
  std::vector<double> w;
  LegendreFit<8> direct;
  Eigen::Matrix<double, 9, 2> tail = Eigen::Matrix<double, 9, 2>::Zero();
  double weight = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    u.push_back(uniform(rng));
    v.push_back(uniform(rng));
    w.push_back(1.5 + uniform(rng));
    direct.add(u.back(), v.back(), w.back());
    const LegendreVector<11> p = legendre<11>(u.back());
    tail += w.back() * p.head<9>() * p.tail<2>().transpose();
    weight += w.back();
  }
  const LegendreSums<19, 9> sums(u, v, w);
  // Of each sum: a rounding a point, and those of a product's dozen terms.
  const double rounding = (kPoints + 64) * std::numeric_limits<double>::epsilon() * weight;
  const Eigen::Matrix<double, 9, 9> gram = sums.products<9, 9>();
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j <= i; ++j) {
      EXPECT_NEAR(gram(i, j), direct.normal()(i, j), rounding) << i << " " << j;
    }
    EXPECT_NEAR(sums.moments()[i], direct.moments()[i], rounding) << i;
  }
  EXPECT_LT((sums.products<9, 2, 9>() - tail).cwiseAbs().maxCoeff(), rounding);
}

}  // namespace
}  // namespace palpate
