// Feet that were followed to the wrong arm of a cusp.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

/// Optimum from feet that start where the points were touched, and from such that start on the
/// other arm wherever that is near.
TEST(WrongArms, AreLeftForTheRightOnes) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  constexpr double kSigma = 1e-4;
  constexpr double kNearTheCusp = 0.08;
  int wrong = 0;
  for (int scene = 0; scene < 20; ++scene) {
    PolynomialFit right;
    right.coefficients.col(2) = Vec2(1.0, uniform(rng) - 0.5);
    right.coefficients.col(3) = Vec2(0.0, 0.2 + uniform(rng));
    PolynomialFit flipped = right;
    std::vector<FitPoint> points;
    int flips = 0;
    for (int i = 0; i <= 110; ++i) {
      const double t = -1.0 + 2.0 * i / 110.0 + 1e-3;
      FitPoint point;
      point.position = position_at(right.coefficients, t) + kSigma * Vec2(normal(rng), normal(rng));
      point.inverse_sigma = 1.0 / kSigma;
      points.push_back(point);
      right.t.push_back(t);
      const bool flip = std::abs(t) < kNearTheCusp;
      const Vec2 other = position_at(right.coefficients, -t);
      wrong += flip && (other - point.position).norm() > 5.0 * kSigma ? 1 : 0;
      flipped.t.push_back(flip ? -t : t);
      flips += flip ? 1 : 0;
    }
    for (const PolynomialModel model :
         {PolynomialModel::SemiCubicalParabola, PolynomialModel::CubicSpline}) {
      const double least =
          refine_polynomial(model, points, right, 0, {}, test::unbounded_work()).chi2;
      // A foot is sought where its point is three deviations off: each may leave as much.
      EXPECT_LE(refine_polynomial(model, points, flipped, 0, {}, test::unbounded_work()).chi2,
                least + 9.0 * flips)
          << scene;
    }
  }
  EXPECT_GT(wrong, 20);  // of some 180 that are flipped
}

}  // namespace
}  // namespace palpate
