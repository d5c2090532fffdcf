#include "core/recognition/fit/orthogonal/touchable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// Points round the tip of a needle that is many times thicker than the noise, as unevenly spaced
/// as those of sections are. Chords round the tip run across it or against the way along either
/// side.
TEST(Touchable, IsTheNeedleRoundWhoseTipAStrokeLed) {
  constexpr int kPoints = 18;
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < test::stress_count(300); ++draw) {
    const double b = test::log_uniform(rng, 0.02, 0.1);
    const double sigma = b * test::log_uniform(rng, 1e-3, 0.02);
    std::vector<double> angles;
    for (int i = 0; i < kPoints; ++i) {
      angles.push_back(test::uniform(rng, -0.7, 0.7));
    }
    std::sort(angles.begin(), angles.end());
    std::vector<Vec2> places;
    for (const double angle : angles) {
      const double x = std::cos(angle) + sigma * normal(rng);
      places.emplace_back(x, b * std::sin(angle) + sigma * normal(rng));
    }
    EXPECT_TRUE(touchable(conic(1.0, b, 1.0), places, sigma)) << draw << ": " << b << ", " << sigma;
  }
}

/// The way back is no longer than two points, amid a stroke or at its end.
TEST(Touchable, IsAConicAlongWhichTheProbeWentBackALittle) {
  const auto along = [](const std::vector<double>& angles) {
    std::vector<Vec2> places;
    for (const double angle : angles) {
      places.emplace_back(std::cos(angle), 0.5 * std::sin(angle));
    }
    return places;
  };
  const ConicCoefficients ellipse = conic(1.0, 0.5, 1.0);
  EXPECT_TRUE(touchable(
      ellipse, along({0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.42, 0.3, 0.38, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}),
      1e-3));
  EXPECT_TRUE(touchable(ellipse, along({0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.65, 0.6}), 1e-3));
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

/// Every 60 degrees round an ellipse. Where nobody states the noise it may be told by what leaves
/// form, and be larger than the steps: a stroke then shows no direction, unless it is held against
/// what the ellipse itself leaves of it.
TEST(Touchable, IsJudgedByNoMoreNoiseThanTheFitLeaves) {
  constexpr double kTooLarge = 0.17;  // of a
  constexpr double kSigma = 1e-3;
  const ConicCoefficients ellipse = conic(1.0, 0.5, 1.0);
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kSigma);
  for (int draw = 0; draw < test::stress_count(100); ++draw) {
    const double first = test::uniform(rng, 0.0, 2.0 * kPi);
    std::vector<Vec2> places;
    for (int i = 0; i < 18; ++i) {
      const double angle = first + kPi / 3.0 * i;
      const double x = std::cos(angle) + noise(rng);
      places.emplace_back(x, 0.5 * std::sin(angle) + noise(rng));
    }
    EXPECT_TRUE(touchable(ellipse, places, kTooLarge)) << draw;
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

/// Where a hyperbola's a is as small as the noise, this takes points at the vertex beyond its
/// conjugate axis. But where it takes most of them to either side, these are two branches.
TEST(Touchable, IsABranchFromWhoseVertexNoiseTakesPoints) {
  constexpr double kSigma = 0.01;
  const ConicCoefficients q = conic(0.01, 0.02, -1.0);
  const std::vector<Vec2> one = {{0.4, -0.8}, {0.2, -0.4}, {0.1, -0.2}, {-0.01, 0.01},
                                 {0.1, 0.2},  {0.2, 0.4},  {0.4, 0.8}};
  EXPECT_TRUE(touchable(q, one, kSigma));
  std::vector<Vec2> of_line;
  for (int i = 0; i < 15; ++i) {
    of_line.emplace_back(i % 2 == 0 ? 0.01 : -0.01, -0.7 + 0.1 * i);
  }
  EXPECT_FALSE(touchable(conic(0.01, 1.0, -1.0), of_line, kSigma));
}

}  // namespace
}  // namespace palpate
