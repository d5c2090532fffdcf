// The feet of a stroke over a cubic of a given class go along it as the probe went.
#include "core/recognition/given/stroke_feet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "core/curves/all_feet.h"
#include "core/curves/curve.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/seated_feet.h"
#include "tests/support/random_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

PlacedCurve<double> cusp_of(double a, double b) {
  PlacedCurve<double> placed;
  placed.curve_class = CurveClass::SemiCubicalParabola;
  placed.shape[0] = a;
  placed.shape[1] = b;
  return placed;
}

WeighedPoint<double> touch(const Vec2& place, std::size_t stroke) {
  WeighedPoint<double> point;
  point.position = {place.x(), place.y()};
  point.weight = 1.0;
  point.stroke = stroke;
  return point;
}

/// In the middle between the arms, or nearer to this one and that one in turns.
std::vector<WeighedPoint<double>> along_the_axis(std::size_t stroke) {
  std::vector<WeighedPoint<double>> points;
  for (int i = 0; i < 40; ++i) {
    points.push_back(touch({0.2 + 0.02 * i, i % 3 == 0 ? 1e-3 : -1e-3}, stroke));
  }
  return points;
}

std::size_t on_upper_arm(const PlacedCurve<double>& placed) {
  return static_cast<std::size_t>(
      std::count_if(placed.feet.begin(), placed.feet.end(),
                    [](const PlaneVector<double>& foot) { return foot.x > 0.0; }));
}

TEST(StrokeFeet, AStrokeBesideACuspKeepsToOneArm) {
  PlacedCurve<double> placed = cusp_of(0.01, 0.0);
  const auto touches = along_the_axis(0);
  ASSERT_TRUE(seat_globally(&placed, touches));
  EXPECT_EQ(on_upper_arm(placed), 14U);
  const auto stroke = along_the_axis(1);
  ASSERT_TRUE(seat_globally(&placed, stroke));
  EXPECT_EQ(on_upper_arm(placed), 0U) << "most points are nearer to the lower one";
}

/// Over the cusp of (t^2, t^3 / 20 + 3 t^2 / 10), from t = 1 to -1 in even steps along the axis,
/// without the samples that are nearer to the cusp than `hole`.
std::vector<WeighedPoint<double>> over_the_cusp(double sigma, double hole) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<WeighedPoint<double>> stroke;
  for (int i = 0; i <= 40; ++i) {
    const double root = 1.0 - 0.05 * i;
    const double t = std::copysign(std::sqrt(std::abs(root)), root);
    const double y = noise(rng);
    if (std::abs(root) >= hole) {
      stroke.push_back(touch(SemiCubicalParabola{0.05, 0.3}.position(t) + Vec2(noise(rng), y), 1));
    }
  }
  return stroke;
}

TEST(StrokeFeet, AStrokeOverACuspChangesArmsThere) {
  PlacedCurve<double> placed = cusp_of(0.05, 0.3);
  const auto stroke = over_the_cusp(0.01, 0.0);
  ASSERT_TRUE(seat_globally(&placed, stroke));
  EXPECT_EQ(jumps_of(placed, stroke), 0);
  int changes = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    if (placed.feet[i - 1].x * placed.feet[i].x < 0.0) {
      ++changes;
      EXPECT_LT(std::abs(static_cast<double>(i) - 20.0), 4.0);
    }
  }
  EXPECT_GE(changes, 1);
  EXPECT_GT(placed.feet.front().x, 0.9);
  EXPECT_LT(placed.feet.back().x, -0.9);
}

// Where a probe has lost the part about the cusp, its stroke goes on elsewhere than it can have
// come to: once.
TEST(StrokeFeet, AStrokeWithAHoleLiesOnBothArms) {
  PlacedCurve<double> placed = cusp_of(0.05, 0.3);
  const auto stroke = over_the_cusp(0.002, 0.42);
  ASSERT_TRUE(seat_globally(&placed, stroke));
  EXPECT_EQ(jumps_of(placed, stroke), 1);
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    EXPECT_EQ(placed.feet[i].x > 0.0, 2 * i < stroke.size()) << i;
  }
}

/// The same, without noise but to either side in turns.
std::vector<WeighedPoint<double>> beside_the_cusp(double off, double stated_sigma) {
  std::vector<WeighedPoint<double>> stroke;
  for (int i = 0; i <= 40; ++i) {
    const double root = 1.0 - 0.05 * i;
    const double t = std::copysign(std::sqrt(std::abs(root)), root);
    if (std::abs(root) < 0.42) continue;
    const Vec2 place = SemiCubicalParabola{0.05, 0.3}.position(t);
    stroke.push_back(touch({place.x(), place.y() + (i % 2 == 0 ? off : -off)}, 1));
    stroke.back().stated = stated_sigma > 0.0;
    stroke.back().weight = stated_sigma > 0.0 ? 1.0 / stated_sigma : 1.0;
  }
  return stroke;
}

// Between the arms, 0.03 to 0.1 apart, the squares of the twelve samples behind the hole fall by
// 0.05 in all if they go to their own arm: by 85 variances of a noise of 0.025, where odds of one
// in a million cost 28, and by 5 of a noise of 0.1, which the samples are off by.
TEST(StrokeFeet, AJumpCostsItsOddsByTheStatedNoise) {
  const auto jumps_at = [](double stated_sigma) {
    PlacedCurve<double> placed = cusp_of(0.05, 0.3);
    const auto stroke = beside_the_cusp(0.1, stated_sigma);
    EXPECT_TRUE(seat_globally(&placed, stroke));
    return jumps_of(placed, stroke);
  };
  EXPECT_EQ(jumps_at(0.025), 1);
  EXPECT_EQ(jumps_at(0.1), 0);
  EXPECT_EQ(jumps_at(0.0), 0) << "the noise of the residuals";
}

// Without order, the nearest place is all that is known.
TEST(StrokeFeet, AStrokeInNoOrderIsFittedAsSingleTouches) {
  auto rng = test::test_rng();
  test::SceneOptions options;
  options.patches = 1;
  options.points_per_patch = 40;
  options.sigma_over_size = 0.003;
  options.least_fraction = options.most_fraction = 0.4;
  const test::Scene scene = test::random_scene(CurveClass::SemiCubicalParabola, options, rng);
  std::vector<Vec2> places = scene.patches.front();
  std::shuffle(places.begin(), places.end(), rng);
  std::vector<GivenPoint> points(places.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].position_m = places[i];
    points[i].sigma_m = scene.sigma_m;
  }
  const GivenFit touches = fit_given_class(scene.curve_class, points);
  for (GivenPoint& point : points) point.stroke = 1;
  const GivenFit stroke = fit_given_class(scene.curve_class, points);
  EXPECT_EQ(touches.chi2, stroke.chi2);
  EXPECT_EQ(touches.shape.values, stroke.shape.values);
}

/// How far the probe went at most between samples i - 1 and i: no more than there and in the steps
/// beside, with what noise adds.
double way(const std::vector<Vec2>& stroke, std::size_t i) {
  double sum = 0.0;
  for (std::size_t k = i > 1 ? i - 2 : 0; k < std::min(i + 1, stroke.size() - 1); ++k) {
    sum += (stroke[k + 1] - stroke[k]).norm();
  }
  return sum;
}

// A cusp laid over the noise explains a part of it by samples now on the one arm, now on the other.
TEST(StrokeFeet, NoFitHasAStrokeThatJumpsBetweenTheArms) {
  auto rng = test::test_rng();
  int fitted = 0;
  const int scenes = test::stress_count(40);
  for (int i = 0; i < scenes; ++i) {
    test::SceneOptions options;
    options.patches = 2;
    options.points_per_patch = 40;
    options.sigma_over_size = test::log_uniform(rng, 0.003, 0.01);
    const test::Scene scene = test::random_scene(CurveClass::SemiCubicalParabola, options, rng);
    std::vector<GivenPoint> points;
    for (std::size_t p = 0; p < scene.patches.size(); ++p) {
      for (const Vec2& place : scene.patches[p]) {
        GivenPoint& point = points.emplace_back();
        point.position_m = place;
        point.sigma_m = scene.sigma_m;
        point.stroke = p + 1;
      }
    }
    const GivenFit fit = fit_given_class(scene.curve_class, points);
    if (fit.status != GivenStatus::Fitted) continue;
    ++fitted;
    const auto curve = make_curve(scene.curve_class, fit.shape.values);
    ASSERT_TRUE(curve.has_value());
    int jumps = 0;
    std::size_t at = 0;
    for (const auto& stroke : scene.patches) {
      for (std::size_t k = 1; k < stroke.size(); ++k) {
        const double before = fit.residuals[at + k - 1].t;
        const double after = fit.residuals[at + k].t;
        // Chords up to the cusp and from there, as the rule has it.
        const double chords = position(*curve, before).norm() + position(*curve, after).norm();
        jumps += before * after < 0.0 && chords > 1.01 * way(stroke, k) ? 1 : 0;
      }
      at += stroke.size();
    }
    // One may be worth its odds, as if samples were missing; there and back none is.
    EXPECT_LE(jumps, 1) << "scene " << i;
  }
  EXPECT_GE(fitted, scenes / 2);
}

// Any foot is as near as those beside it, and the nearest of all is among them.
TEST(AllFeet, HoldTheNearestOne) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  const auto expect_nearest = [&](const auto& curve) {
    for (int i = 0; i < 200; ++i) {
      const Vec2 point(normal(rng), normal(rng));
      const FootPlaces feet = all_feet(curve, point);
      ASSERT_GE(feet.count, 1U);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < feet.count; ++k) {
        least = std::min(least, (curve.position(feet.t[k]) - point).norm());
      }
      EXPECT_NEAR(least, std::abs(curve.foot_point(point).distance), 1e-9);
    }
  };
  expect_nearest(CubicalParabola{2.0, -1.5});
  expect_nearest(SemiCubicalParabola{0.7, 0.4});
  expect_nearest(CubicSpline{0.7, 0.4, -0.3});
}

}  // namespace
}  // namespace palpate
