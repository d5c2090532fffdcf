// The feet of a stroke over a cubic of a given class go along it as the probe went.
#include "core/recognition/given/placed/stroke_feet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/placed/seated_feet.h"
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

/// Parameters of the feet, one after the other.
std::vector<double> feet_of(const PlacedCurve<double>& placed) {
  std::vector<double> t;
  for (const PlaneVector<double>& foot : placed.feet) t.push_back(foot.x);
  return t;
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

// The S of y = x^3 / 2w^3 - 3 x / 2w turns back in y at -w and w, where it is 1 and -1 high: three
// branches side by side, for half of its height less than 2 w apart.
constexpr double kHalfWidth = 0.01;

PlacedCurve<double> sharp_s() {
  PlacedCurve<double> placed;
  placed.curve_class = CurveClass::CubicalParabola;
  placed.shape[0] = 0.5 / (kHalfWidth * kHalfWidth * kHalfWidth);
  placed.shape[1] = -1.5 / kHalfWidth;
  return placed;
}

TEST(StrokeFeet, AStrokeBesideAnSKeepsToOneBranch) {
  std::vector<WeighedPoint<double>> points;
  for (int i = 0; i < 40; ++i) {
    // At a height of 0 the branches are at -1.73 w, 0 and 1.73 w.
    const double x = (-0.87 + (i % 3 == 0 ? 0.2 : -0.2)) * kHalfWidth;
    points.push_back(touch({x, 0.01 * (i - 20)}, 0));
  }
  PlacedCurve<double> placed = sharp_s();
  const auto on_left_one = [&] {
    const auto feet = feet_of(placed);
    return std::count_if(feet.begin(), feet.end(), [](double t) { return t < -kHalfWidth; });
  };
  ASSERT_TRUE(seat_globally(&placed, points));
  EXPECT_EQ(on_left_one(), 26);
  for (WeighedPoint<double>& point : points) point.stroke = 1;
  EXPECT_EQ(jumps_of(placed, points), 26);  // there and back for each of 13 after the first one
  ASSERT_TRUE(seat_globally(&placed, points));
  EXPECT_EQ(on_left_one(), 40) << "most points are nearer to the left branch";
  EXPECT_EQ(jumps_of(placed, points), 0);
}

// Up the left branch, over the bend at its top, and down the one in the middle.
TEST(StrokeFeet, AStrokeOverTheBendOfAnSChangesBranchesThere) {
  std::vector<WeighedPoint<double>> points;
  for (int i = 0; i <= 80; ++i) {
    const double x = -1.7 + 0.02 * i;  // at the bend: -1, where i is 35
    // Every third one lies beyond the middle between the branches.
    const double off = i % 3 == 0 ? -1.2 * (x + 1.0) : 0.0;
    points.push_back(touch({(x + off) * kHalfWidth, 0.5 * x * x * x - 1.5 * x}, 0));
  }
  PlacedCurve<double> placed = sharp_s();
  const auto out_of_order = [&] {
    int count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool near_bend = i > 30 && i < 40;
      count += !near_bend && (placed.feet[i].x < -kHalfWidth) != (i < 35) ? 1 : 0;
    }
    return count;
  };
  ASSERT_TRUE(seat_globally(&placed, points));
  EXPECT_EQ(out_of_order(), 24) << "every third one";
  for (WeighedPoint<double>& point : points) point.stroke = 1;
  ASSERT_TRUE(seat_globally(&placed, points));
  EXPECT_EQ(out_of_order(), 0);
  EXPECT_EQ(jumps_of(placed, points), 0);
}

// A spline whose c is small has two arms, and no cusp but a bend where they meet.
TEST(StrokeFeet, AStrokeBesideTheBendOfASplineKeepsToOneArm) {
  PlacedCurve<double> placed = cusp_of(0.01, 0.0);
  placed.curve_class = CurveClass::CubicSpline;
  placed.shape[2] = 1e-3;
  ASSERT_TRUE(seat_globally(&placed, along_the_axis(0)));
  EXPECT_EQ(on_upper_arm(placed), 14U);
  const auto stroke = along_the_axis(1);
  EXPECT_EQ(jumps_of(placed, stroke), 26);
  ASSERT_TRUE(seat_globally(&placed, stroke));
  EXPECT_EQ(on_upper_arm(placed), 0U) << "most points are nearer to the lower one";
  EXPECT_EQ(jumps_of(placed, stroke), 0);
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

/// A stroke along each arm of a cusp. The noise is a tenth of the distance between them.
std::vector<std::vector<Vec2>> along_both_arms(double sigma, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<std::vector<Vec2>> strokes(2);
  for (int i = 0; i < 80; ++i) {
    const double x = 0.3 + 0.7 * (i % 40) / 39.0;
    const double t = i < 40 ? std::sqrt(x) : -std::sqrt(x);
    const double y = noise(rng);
    strokes[i < 40 ? 0 : 1].push_back(SemiCubicalParabola{0.5, 0.3}.position(t) +
                                      Vec2(noise(rng), y));
  }
  return strokes;
}

/// How often neighbours along a stroke lie on different arms, both farther from the cusp than the
/// probe can have gone to it and back: three times its longest step.
int changes_of_arm(const std::vector<Vec2>& stroke, const Curve& curve,
                   std::span<const GivenResidual> residuals) {
  double longest = 0.0;
  for (std::size_t k = 1; k < stroke.size(); ++k) {
    longest = std::max(longest, (stroke[k] - stroke[k - 1]).norm());
  }
  int changes = 0;
  for (std::size_t k = 1; k < stroke.size(); ++k) {
    const double before = residuals[k - 1].t;
    const double after = residuals[k].t;
    const double nearer = std::min(position(curve, before).norm(), position(curve, after).norm());
    changes += before * after < 0.0 && 2.0 * nearer > 3.0 * longest ? 1 : 0;
  }
  return changes;
}

// A cusp laid across the strokes explains a part of the noise by samples now on the one arm, now on
// the other.
TEST(StrokeFeet, NoFitHasAStrokeThatJumpsBetweenTheArms) {
  constexpr double kSigma = 0.05;
  auto rng = test::test_rng();
  int jumping_touches = 0;
  const int scenes = test::stress_count(20);
  for (int i = 0; i < scenes; ++i) {
    const auto strokes = along_both_arms(kSigma, rng);
    for (const bool told : {false, true}) {
      std::vector<GivenPoint> points;
      for (std::size_t p = 0; p < strokes.size(); ++p) {
        for (const Vec2& place : strokes[p]) {
          GivenPoint& point = points.emplace_back();
          point.position_m = place;
          point.sigma_m = kSigma;
          point.stroke = told ? p + 1 : 0;
        }
      }
      const GivenFit fit = fit_given_class(CurveClass::SemiCubicalParabola, points);
      ASSERT_EQ(fit.status, GivenStatus::Fitted) << "scene " << i;
      const auto curve = make_curve(fit.shape.curve_class, fit.shape.values);
      ASSERT_TRUE(curve.has_value());
      const std::span<const GivenResidual> residuals(fit.residuals);
      const int changes = changes_of_arm(strokes[0], *curve, residuals.first(40)) +
                          changes_of_arm(strokes[1], *curve, residuals.last(40));
      if (told) {
        EXPECT_EQ(changes, 0) << "scene " << i;
      } else {
        jumping_touches += changes > 0 ? 1 : 0;
      }
    }
  }
  if (test::counts_tell()) {
    EXPECT_GT(jumping_touches, 0) << "nothing that the order of strokes would have to exclude";
  }
}

}  // namespace
}  // namespace palpate
