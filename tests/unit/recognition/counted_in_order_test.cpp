// What a polynomial curve leaves of strokes that go along it in order.
#include "core/recognition/fit/orthogonal/counted_in_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

constexpr double kPointSigma = 0.05;

/// x = t^3 - 3 t, y = `apart` t: three branches beside each other for |x| < 2.
PolynomialFit beside_each_other(double apart) {
  PolynomialFit fit;
  fit.coefficients.col(1) = Vec2(-3.0, apart);
  fit.coefficients.col(3) = Vec2(1.0, 0.0);
  return fit;
}

void add_point(const Vec2& place, std::mt19937_64& rng, FitData* data) {
  FitPoint point;
  point.position = place + test::normal_pair(rng, kPointSigma);
  point.inverse_sigma = 1.0 / kPointSigma;
  data->points.push_back(point);
}

/// The nearest foot of each point, wherever it is.
PolynomialFit with_nearest_feet(PolynomialFit fit, const FitData& data) {
  fit.chi2 = 0.0;
  for (const FitPoint& point : data.points) {
    fit.t.push_back(nearest_parameter(fit.coefficients, point.position));
    fit.chi2 +=
        ((position_at(fit.coefficients, fit.t.back()) - point.position) * point.inverse_sigma)
            .squaredNorm();
  }
  return fit;
}

TEST(CountedInOrder, AStrokeOverThreeBranchesIsOnOneOfThem) {
  std::mt19937_64 rng = test::test_rng();
  FitData data;
  for (int i = 0; i < 200; ++i) add_point(Vec2(-1.0 + 2.0 * i / 199.0, 0.0), rng, &data);
  data.patches = {{0, data.points.size()}};
  const PolynomialFit nearest = with_nearest_feet(beside_each_other(kPointSigma), data);
  const PolynomialFit ordered = counted_in_order(nearest, data, test::unbounded_work());
  // On the middle branch, which falls from t = -1 to 1; beside it the others take a part of what
  // noise leaves.
  for (std::size_t i = 0; i < ordered.t.size(); ++i) {
    EXPECT_LT(std::abs(ordered.t[i]), 1.0) << i;
  }
  double chi2 = 0.0;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Vec2 away = position_at(ordered.coefficients, ordered.t[i]) - data.points[i].position;
    chi2 += (away / kPointSigma).squaredNorm();
  }
  EXPECT_NEAR(ordered.chi2, chi2, 1e-9 * chi2);
  EXPECT_GT(ordered.chi2, nearest.chi2 + 10.0);
}

TEST(CountedInOrder, AStrokeThatGoesAlongAllBranchesStaysAsItIs) {
  std::mt19937_64 rng = test::test_rng();
  const PolynomialFit curve = beside_each_other(20.0 * kPointSigma);
  FitData data;
  for (int i = 0; i < 300; ++i) {
    add_point(position_at(curve.coefficients, -2.2 + 4.4 * i / 299.0), rng, &data);
  }
  data.patches = {{0, data.points.size()}};
  const PolynomialFit nearest = with_nearest_feet(curve, data);
  const PolynomialFit ordered = counted_in_order(nearest, data, test::unbounded_work());
  EXPECT_EQ(ordered.chi2, nearest.chi2);
  EXPECT_EQ(ordered.t, nearest.t);
}

TEST(CountedInOrder, SingleTouchesHaveNone) {
  std::mt19937_64 rng = test::test_rng();
  FitData data;
  for (int i = 0; i < 40; ++i) {
    add_point(Vec2(-1.0 + 2.0 * i / 39.0, 0.0), rng, &data);
    data.patches.push_back({data.points.size() - 1, data.points.size()});
  }
  const PolynomialFit nearest = with_nearest_feet(beside_each_other(kPointSigma), data);
  EXPECT_EQ(counted_in_order(nearest, data, test::unbounded_work()).t, nearest.t);
}

}  // namespace
}  // namespace palpate
