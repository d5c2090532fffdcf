#include "core/recognition/fit/orthogonal/touchable.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/recognition/fit/orthogonal/polynomial_foot.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// x^2 / a^2 + sign y^2 / b^2 = 1.
ConicCoefficients conic(double a, double b, double sign) {
  ConicCoefficients q;
  q << 1.0 / (a * a), 0.0, sign / (b * b), 0.0, 0.0, -1.0;
  return q.normalized();
}

bool touchable(const ConicCoefficients& q, const std::vector<Vec2>& places, double sigma) {
  FitData data;
  for (const Vec2& place : places) {
    FitPoint point;
    point.position = place;
    point.inverse_sigma = 1.0 / sigma;
    data.points.push_back(point);
  }
  data.patches = {{0, data.points.size()}};
  ImplicitFit fit;
  fit.coefficients = q;
  return is_touchable(placed_on(data.points, fit), data);
}

/// Along the lower side of a needle; at its ends, which are no thicker than the noise, noise has
/// taken the points to the upper side.
TEST(Touchable, IsANeedleWhoseEndsTellNoSide) {
  const std::vector<Vec2> lower = {{0.98, 0.004},   {0.85, -0.015},  {0.62, -0.023},
                                   {0.33, -0.028},  {0.0, -0.030},   {-0.33, -0.028},
                                   {-0.62, -0.023}, {-0.85, -0.015}, {-0.98, 0.004}};
  EXPECT_TRUE(touchable(conic(1.0, 0.03, 1.0), lower, 0.003));
}

/// A thin ellipse explains noise about a line if neighbours may lie on opposite sides of it,
/// whether or not it is thicker than the noise.
TEST(Touchable, IsNoNeedleThatExplainsTheNoiseOfALine) {
  std::vector<Vec2> places;
  for (int i = 0; i < 15; ++i) {
    places.emplace_back(-0.9 + 1.8 * i / 14, i % 2 == 0 ? 0.01 : -0.01);
  }
  for (const double sigma : {0.001, 0.003, 0.01}) {
    EXPECT_FALSE(touchable(conic(1.0, 0.01, 1.0), places, sigma)) << sigma;
  }
}

/// The samples' nearest feet on a curve, in their order.
bool touchable(const PolynomialCoefficients& c, const std::vector<Vec2>& places, double sigma) {
  FitData data;
  PolynomialFit fit;
  fit.coefficients = c;
  for (const Vec2& place : places) {
    FitPoint point;
    point.position = place;
    point.inverse_sigma = 1.0 / sigma;
    data.points.push_back(point);
    fit.t.push_back(nearest_parameter(c, place));
  }
  data.patches = {{0, data.points.size()}};
  return is_touchable(fit, data);
}

/// Three strands side by side leave less of a cloud than the one along it. But a probe that goes up
/// once does not go from strand to strand and back at every other sample, though the stroke is too
/// short for its noise to show a direction.
TEST(Touchable, IsNoCubicThatThreadsACloud) {
  constexpr double kSigma = 0.05;
  PolynomialCoefficients s_curve;  // (0.05 t, t^3 - t)
  s_curve << 0.0, 0.05, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0;
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, kSigma);
  std::vector<Vec2> cloud;
  std::vector<Vec2> in_order;
  for (int i = 0; i <= 200; ++i) {
    const double s = i / 100.0 - 1.0;
    cloud.emplace_back(normal(rng), 0.17 * s + normal(rng));
    in_order.push_back(position_at(s_curve, 1.2 * s));
  }
  EXPECT_FALSE(touchable(s_curve, cloud, kSigma));
  EXPECT_TRUE(touchable(s_curve, in_order, kSigma));
}

TEST(Touchable, IsOneBranchOfAHyperbola) {
  const ConicCoefficients q = conic(0.2, 0.2, -1.0);
  const std::vector<Vec2> right = {
      {0.45, -0.4}, {0.28, -0.2}, {0.2, 0.0}, {0.28, 0.2}, {0.45, 0.4}};
  std::vector<Vec2> both = right;
  both.back().x() = -both.back().x();
  EXPECT_TRUE(touchable(q, right, 1e-3));
  EXPECT_FALSE(touchable(q, both, 1e-3));
}

}  // namespace
}  // namespace palpate
