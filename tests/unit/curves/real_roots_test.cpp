// Roots of polynomials made from known roots.
#include "core/numerics/polynomials/real_roots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

template <int kDegree>
Polynomial<kDegree> product_of(const std::vector<double>& roots, double leading) {
  Polynomial<kDegree> c = Polynomial<kDegree>::Zero();
  c[0] = leading;
  int degree = 0;
  for (const double root : roots) {
    for (int k = ++degree; k > 0; --k) {
      c[k] = c[k - 1] - root * c[k];
    }
    c[0] *= -root;
  }
  return c;
}

template <int kDegree>
std::vector<double> roots_of(const Polynomial<kDegree>& c) {
  std::vector<double> roots;
  visit_real_roots<kDegree>(c, [&](double root) { roots.push_back(root); });
  return roots;
}

TEST(RealRoots, FindsDistinctRootsAtAnyScale) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> gap(0.2, 1.0);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (int i = 0; i < test::stress_count(1000); ++i) {
      std::vector<double> expected = {-1.5};
      while (expected.size() < 5) {
        expected.push_back(expected.back() + gap(rng));
      }
      for (double& root : expected) {
        root *= scale;
      }
      const auto roots = roots_of<5>(product_of<5>(expected, -3.0));
      ASSERT_EQ(roots.size(), 5U);
      for (std::size_t k = 0; k < 5; ++k) {
        // |r|^5 <= 2.5^5 in rounding of the coefficients over the least slope 0.2 * .4 * .6 * .8
        // / 2.
        EXPECT_NEAR(roots[k], expected[k], 1e-11 * scale);
      }
    }
  }
}

TEST(RealRoots, ComplexRootsAreNone) {
  EXPECT_TRUE(roots_of<4>((Polynomial<4>() << 1.0, 0.0, 1.0, 0.0, 1.0).finished()).empty());
  EXPECT_EQ(roots_of<5>((Polynomial<5>() << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0).finished()),
            std::vector<double>{0.0});
}

TEST(RealRoots, OddMultiplicityIsNeverLost) {
  for (const double root : {0.0, 1.0 / 3.0, -7.0}) {
    const std::vector<double> expected = {root, root, root, root + 1.0, root - 2.0};
    const auto roots = roots_of<5>(product_of<5>(expected, 1.0));
    ASSERT_GE(roots.size(), 3U);
    // The polynomial is 2 (x - root)^3 there; the roundings of its coefficients and of its value,
    // each at most 5 of the product of the sizes, hide it below their cube root.
    double rounding = 10.0 * std::numeric_limits<double>::epsilon();
    double nearest = 1.0;
    for (const double r : expected) {
      rounding *= std::abs(root) + std::abs(r);
    }
    for (const double found : roots) {
      nearest = std::min(nearest, std::abs(found - root));
    }
    EXPECT_LE(nearest, std::cbrt(rounding / 2.0)) << root;
  }
}

/// Each root is one as far as the polynomial's own rounding lets it be told, also where roots lie
/// so close together that Newton's steps are rounding: 2 * 5 roundings of the terms, of half an
/// epsilon each, and as many of the polynomial in the scaled unknown.
TEST(RealRoots, ValuesAreRounding) {
  constexpr double kRounding = 10.0 * std::numeric_limits<double>::epsilon();
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  for (const double apart : {1.0, 1e-3, 1e-6, 1e-9}) {
    for (int i = 0; i < test::stress_count(1000); ++i) {
      std::vector<double> near;
      const double middle = place(rng);
      while (near.size() < 5) {
        near.push_back(near.size() < 3 ? middle + apart * place(rng) : place(rng));
      }
      const Polynomial<5> c = product_of<5>(near, 0.7);
      const std::vector<double> roots = roots_of<5>(c);
      EXPECT_FALSE(roots.empty());
      for (const double root : roots) {
        double value = 0.0;
        double terms = 0.0;
        for (int k = 5; k >= 0; --k) {
          value = value * root + c[k];
          terms = terms * std::abs(root) + std::abs(c[k]);
        }
        EXPECT_LE(std::abs(value), kRounding * terms) << root << ", " << apart;
      }
    }
  }
}

TEST(RealRoots, VanishingLeadingCoefficientsLowerTheDegree) {
  const auto roots = roots_of<5>((Polynomial<5>() << -6.0, 5.0, 1.0, 0.0, 0.0, 0.0).finished());
  ASSERT_EQ(roots.size(), 2U);
  EXPECT_NEAR(roots[0], -6.0, 1e-14);
  EXPECT_NEAR(roots[1], 1.0, 1e-15);
  EXPECT_TRUE(roots_of<5>(Polynomial<5>::Zero()).empty());
  EXPECT_TRUE(
      roots_of<3>(Polynomial<3>::Constant(std::numeric_limits<double>::quiet_NaN())).empty());
}

}  // namespace
}  // namespace palpate
