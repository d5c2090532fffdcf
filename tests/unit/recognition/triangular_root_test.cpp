#include "core/numerics/matrices/triangular_root.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using Rows = Eigen::Matrix<double, 5, 4>;

Rows random_rows(std::mt19937_64& rng) {
  Rows rows;
  for (double& entry : rows.reshaped()) {
    entry = test::uniform(rng, -1.0, 1.0);
  }
  return rows;
}

TEST(TriangularRoot, IsOfTheSumOfSquares) {
  std::mt19937_64 rng = test::test_rng();
  Eigen::Matrix4d root = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d sum = root;
  for (int i = 0; i < 20; ++i) {
    Rows rows = random_rows(rng);
    rows.col(2).setZero();  // a coordinate that does nothing
    sum += rows.transpose() * rows;
    absorb_rows(&rows, &root);
    EXPECT_TRUE((root.diagonal().array() > 0.0).all());
    EXPECT_EQ(root.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm(), 0.0);
    // Each sum has at most 100 terms of at most 1.
    EXPECT_LT((root * root.transpose() - sum).cwiseAbs().maxCoeff(), 100.0 * 1e-15);
  }
}

TEST(TriangularRoot, KnowsDirectionsThatTheProductsHaveLost) {
  // Two rows that differ by a hundred millionth: the products differ by less than they are rounded.
  const double large = 1e8;
  Eigen::Matrix2d rows;
  rows << large, large, large, large + 1.0;
  Eigen::Matrix2d root = Eigen::Matrix2d::Identity();
  absorb_rows(&rows, &root);
  // Cauchy and Binet: the sum of the squares of all minors of the rows and the identity.
  const double minor = large;
  const double expected = 1.0 + 3.0 * large * large + (large + 1.0) * (large + 1.0) + minor * minor;
  // A reflection of entries of 1.4e8 leaves a few of their roundings in the entry of size 1.6.
  const double rounding = 8.0 * 1.4 * large * std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(root(0, 0) * root(1, 1) / std::sqrt(expected), 1.0, rounding);
}

TEST(TriangularRoot, WithoutACoordinateIsThatOfTheOthers) {
  std::mt19937_64 rng = test::test_rng();
  Rows rows = random_rows(rng);
  for (int k = 0; k < 4; ++k) {
    Rows all = rows;
    Rows others = rows;
    others.col(k).setZero();
    Eigen::Matrix4d root = Eigen::Matrix4d::Identity();
    Eigen::Matrix4d expected = root;
    absorb_rows(&all, &root);
    absorb_rows(&others, &expected);
    EXPECT_LT((root_without(root, k) - expected).cwiseAbs().maxCoeff(), 1e-14) << k;
  }
}

TEST(TriangularRoot, ShowsWhatIsNoNumber) {
  Eigen::Matrix<double, 1, 2> row(1.0, std::numeric_limits<double>::quiet_NaN());
  Eigen::Matrix2d root = Eigen::Matrix2d::Identity();
  absorb_rows<1, 2>(&row, &root);
  EXPECT_FALSE(root.allFinite());
}

}  // namespace
}  // namespace palpate
