#include "core/recognition/fit/touchable.h"

#include <gtest/gtest.h>

#include <vector>

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
