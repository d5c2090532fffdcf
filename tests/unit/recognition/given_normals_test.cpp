// A class that is given, of touches with measured normals and covariances.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/numerics/probability/chi_square.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/placed/orthogonal_squares.h"
#include "tests/support/calibration.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kDegree = kPi / 180.0;

struct Part {
  Curve curve = Ellipse{0.03, 0.02};
  Pose2 world_T_curve{0.2, -0.1, 0.4};
  double from = 0.0;
  double to = 2.0 * kPi;
  double sigma_m = 2e-4;
  double normal_sigma_rad = kDegree;
  double tip_radius_m = 0.0;
};

/// Touches at even parameters, the material inside of the ellipse (left of increasing t).
std::vector<GivenPoint> touch(const Part& part, int count, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<GivenPoint> points;
  for (int i = 0; i < count; ++i) {
    const double t = part.from + (part.to - part.from) * (i + 0.5) / count;
    const double angle =
        geometry(part.curve, t).tangent_angle + part.world_T_curve.theta - 0.5 * kPi;
    const Vec2 outward(std::cos(angle), std::sin(angle));
    GivenPoint& point = points.emplace_back();
    point.position_m = part.world_T_curve * position(part.curve, t) + part.tip_radius_m * outward +
                       part.sigma_m * Vec2(normal(rng), normal(rng));
    point.sigma_m = part.sigma_m;
    point.tip_radius_m = part.tip_radius_m;
    point.normal = Eigen::Rotation2Dd(part.normal_sigma_rad * normal(rng)) * outward;
    point.normal_sigma_rad = part.normal_sigma_rad;
  }
  return points;
}

std::vector<GivenPoint> moved(std::vector<GivenPoint> points, const Pose2& motion) {
  for (GivenPoint& point : points) {
    point.position_m = motion * point.position_m;
    point.normal = motion.rotate(point.normal);
    const double c = std::cos(motion.theta);
    const double s = std::sin(motion.theta);
    Eigen::Matrix2d turn;
    turn << c, -s, s, c;
    Eigen::Matrix2d noise;
    noise << point.covariance_m2.x(), point.covariance_m2.y(), point.covariance_m2.y(),
        point.covariance_m2.z();
    noise = turn * noise * turn.transpose();
    point.covariance_m2 = {noise(0, 0), noise(0, 1), noise(1, 1)};
  }
  return points;
}

TEST(GivenNormals, GradientIsThatOfFiniteDifferences) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const CurveClass curve_class :
       {CurveClass::Line, CurveClass::Circle, CurveClass::Ellipse, CurveClass::Parabola,
        CurveClass::Hyperbola, CurveClass::CubicalParabola, CurveClass::SemiCubicalParabola,
        CurveClass::CubicSpline}) {
    PlacedCurve<double> curve;
    curve.curve_class = curve_class;
    curve.shape[0] = 0.9;
    curve.shape[1] = 0.6;
    curve.shape[2] = 0.3;
    curve.origin = {0.1, -0.2};
    curve.axis = {std::cos(0.7), std::sin(0.7)};
    std::vector<WeighedPoint<double>> points;
    for (int i = 0; i < 6; ++i) {
      const double t = 0.5 + 0.15 * i;
      const bool round = curve_class == CurveClass::Circle || curve_class == CurveClass::Ellipse;
      curve.feet.push_back(round ? PlaneVector<double>{std::cos(t), std::sin(t)}
                                 : PlaneVector<double>{t, 0.0});
      const auto at = curve_point(curve_class, curve.shape, curve.feet.back());
      const PlaneVector<double> near =
          at.position + PlaneVector<double>{0.03 * uniform(rng), 0.03 * uniform(rng)};
      WeighedPoint<double> point;
      point.position = curve.origin + near.x * curve.axis + near.y * left(curve.axis);
      point.weight = 3.0;
      const double angle = 2.0 * kPi * uniform(rng);  // any: residuals need not be small
      point.normal = {std::cos(angle), std::sin(angle)};
      point.normal_weight = 2.0;
      points.push_back(point);
    }
    const auto n = static_cast<std::size_t>(Unknowns(curve_class).count);
    const Squares<double> squares =
        squares_about(&curve, std::span<const WeighedPoint<double>>(points));
    for (std::size_t i = 0; i < n; ++i) {
      constexpr double kStep = 1e-5;
      std::array<double, 2> cost{};
      for (const int way : {0, 1}) {
        PlacedCurve<double> there = curve;
        std::array<double, kMostUnknowns> step{};
        step[i] = way == 0 ? kStep : -kStep;
        there.move(step.data());
        cost[static_cast<std::size_t>(way)] =
            half_squares(&there, std::span<const WeighedPoint<double>>(points));
      }
      // Second order: what is left is the cube of the step, times third derivatives of about 1e2.
      const double slope = (cost[0] - cost[1]) / (2.0 * kStep);
      EXPECT_NEAR(squares.gradient[i], slope, 1e-6 * (1.0 + std::abs(slope)))
          << name_of(curve_class) << ", unknown " << i;
    }
    EXPECT_NEAR(squares.cost, half_squares(&curve, std::span<const WeighedPoint<double>>(points)),
                1e-12 * squares.cost);
  }
}

TEST(GivenNormals, MovedWithThePartTheFitMovesWithIt) {
  auto rng = test::test_rng();
  std::vector<GivenPoint> points = touch(Part{}, 7, rng);
  for (GivenPoint& point : points) point.covariance_m2 = {4e-8, 1e-8, 2e-8};
  const GivenFit fit = fit_given_class(CurveClass::Ellipse, points);
  ASSERT_EQ(fit.status, GivenStatus::Fitted);
  EXPECT_EQ(fit.normals, points.size());
  EXPECT_EQ(fit.dof, 2 * 7 - 5);
  const Pose2 motion{1.5, -0.7, 0.9};
  const GivenFit other = fit_given_class(CurveClass::Ellipse, moved(points, motion));
  ASSERT_EQ(other.status, GivenStatus::Fitted);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(other.shape.values[k], fit.shape.values[k], 1e-12);
  }
  const Vec2 centre = motion * Vec2(fit.world_T_curve.x, fit.world_T_curve.y);
  EXPECT_NEAR(other.world_T_curve.x, centre.x(), 1e-12);
  EXPECT_NEAR(other.world_T_curve.y, centre.y(), 1e-12);
  EXPECT_NEAR(
      std::remainder(other.world_T_curve.theta - fit.world_T_curve.theta - motion.theta, kPi), 0.0,
      1e-10);
  EXPECT_NEAR(other.chi2, fit.chi2, 1e-8 * fit.chi2);
}

TEST(GivenNormals, OfASurfaceTheSignSaysNothing) {
  auto rng = test::test_rng();
  std::vector<GivenPoint> points = touch(Part{}, 6, rng);
  const GivenFit fit = fit_given_class(CurveClass::Ellipse, points);
  for (std::size_t i = 0; i < points.size(); i += 2) points[i].normal *= -1.0;
  const GivenFit turned = fit_given_class(CurveClass::Ellipse, points);
  ASSERT_EQ(fit.status, GivenStatus::Fitted);
  EXPECT_EQ(turned.shape.values, fit.shape.values);
  EXPECT_EQ(turned.chi2, fit.chi2);
}

TEST(GivenNormals, OfATipTheSignIsTheSide) {
  auto rng = test::test_rng();
  Part part;
  part.curve = Circle{0.02};
  part.tip_radius_m = 3e-3;
  std::vector<GivenPoint> points = touch(part, 5, rng);
  const GivenFit outside = fit_given_class(CurveClass::Circle, points);
  for (GivenPoint& point : points) point.normal *= -1.0;
  const GivenFit inside = fit_given_class(CurveClass::Circle, points);
  ASSERT_EQ(outside.status, GivenStatus::Fitted);
  ASSERT_EQ(inside.status, GivenStatus::Fitted);
  // The centres lie on one circle; the surface within it, or round it.
  EXPECT_NEAR(outside.shape.values[0], 0.020, 5e-4);
  EXPECT_NEAR(inside.shape.values[0], 0.026, 5e-4);
}

TEST(GivenNormals, FewerPointsThanUnknownsDetermineTheCurve) {
  auto rng = test::test_rng();
  Part part;
  part.sigma_m = 1e-6;
  part.normal_sigma_rad = 1e-4;
  part.to = 1.5 * kPi;
  const GivenFit ellipse = fit_given_class(CurveClass::Ellipse, touch(part, 3, rng));
  ASSERT_EQ(ellipse.status, GivenStatus::Fitted);
  EXPECT_NEAR(ellipse.shape.values[0], 0.03, 5.0 * std::sqrt(ellipse.covariance(0, 0)));
  EXPECT_NEAR(ellipse.shape.values[1], 0.02, 5.0 * std::sqrt(ellipse.covariance(1, 1)));
  part.curve = Circle{0.02};
  const GivenFit circle = fit_given_class(CurveClass::Circle, touch(part, 2, rng));
  ASSERT_EQ(circle.status, GivenStatus::Fitted);
  EXPECT_EQ(circle.dof, 1);
  EXPECT_NEAR(circle.shape.values[0], 0.02, 5.0 * std::sqrt(circle.covariance(0, 0)));
  // Two points alone do not.
  std::vector<GivenPoint> bare = touch(part, 2, rng);
  for (GivenPoint& point : bare) point.normal_sigma_rad = 0.0;
  EXPECT_EQ(fit_given_class(CurveClass::Circle, bare).status, GivenStatus::TooFewPoints);
}

TEST(GivenNormals, WithoutKnownNoiseTheyDoNotCount) {
  auto rng = test::test_rng();
  std::vector<GivenPoint> points = touch(Part{}, 8, rng);
  for (GivenPoint& point : points) point.sigma_m = 0.0;
  const GivenFit with = fit_given_class(CurveClass::Ellipse, points);
  EXPECT_EQ(with.normals, 0U);
  for (GivenPoint& point : points) point.normal_sigma_rad = 0.0;
  EXPECT_EQ(fit_given_class(CurveClass::Ellipse, points).shape.values, with.shape.values);
}

TEST(GivenNormals, WhatIsNoNoiseIsRefused) {
  auto rng = test::test_rng();
  const std::vector<GivenPoint> good = touch(Part{}, 6, rng);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& spoil : std::vector<void (*)(GivenPoint&)>{
           [](GivenPoint& p) { p.normal.x() = std::numeric_limits<double>::infinity(); },
           [](GivenPoint& p) { p.normal.setZero(); },
           [](GivenPoint& p) { p.normal_sigma_rad = -1.0; },
           [](GivenPoint& p) {
             p.covariance_m2 = {1e-8, 2e-8, 1e-8};
           },
           [](GivenPoint& p) {
             p.covariance_m2 = {0.0, 0.0, 1e-8};
           }}) {
    std::vector<GivenPoint> points = good;
    spoil(points[2]);
    EXPECT_EQ(fit_given_class(CurveClass::Ellipse, points).status, GivenStatus::NotFinite);
  }
  std::vector<GivenPoint> points = good;
  points[1].normal_sigma_rad = nan;
  EXPECT_EQ(fit_given_class(CurveClass::Ellipse, points).status, GivenStatus::NotFinite);
}

/// Mean of the squared normalised errors of (a, b), and how often the 95 % ellipse holds the truth.
struct Held {
  double normalised = 0.0;
  int held = 0;
};

template <typename Touch>
Held held_in(int runs, const Touch& touch_once) {
  const Eigen::Vector2d truth(0.03, 0.02);
  Held held;
  for (int run = 0; run < runs; ++run) {
    const GivenFit fit = fit_given_class(CurveClass::Ellipse, touch_once());
    EXPECT_EQ(fit.status, GivenStatus::Fitted);
    EXPECT_LT(fit.stationarity, 1e-12);
    const Eigen::Vector2d error = fit.shape.values.head<2>() - truth;
    const Eigen::Matrix2d covariance = fit.covariance.topLeftCorner<2, 2>();
    const double square = error.dot(covariance.inverse() * error);
    held.normalised += square / runs;
    held.held += square <= chi_square_threshold(0.05, 2) ? 1 : 0;
  }
  return held;
}

void expect_the_law(const Held& held, int runs) {
  if (!test::counts_tell()) return;
  const auto band =
      test::binomial_band(std::vector<double>(static_cast<std::size_t>(runs), 0.95), 1.0 - 2e-4);
  EXPECT_GE(held.held, band.least);
  // Mean of the chi-square law with two degrees of freedom 2, variance 4.
  EXPECT_NEAR(held.normalised, 2.0, 4.0 * 2.0 / std::sqrt(runs));
}

TEST(GivenNormals, ErrorsHaveTheLawOfTheCovariance) {
  auto rng = test::test_rng();
  const int runs = test::stress_count(400);
  expect_the_law(held_in(runs, [&] { return touch(Part{}, 6, rng); }), runs);
}

TEST(GivenNormals, ALongNoiseWeighsByWhatLiesAlongTheNormal) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  const int runs = test::stress_count(400);
  // A probe ten times as noisy along x.
  const Eigen::Vector3d covariance(1e-8, 0.0, 1e-10);
  Part part;
  part.sigma_m = 0.0;
  const auto touch_once = [&] {
    std::vector<GivenPoint> points = touch(part, 24, rng);
    for (GivenPoint& point : points) {
      point.position_m += Vec2(1e-4 * normal(rng), 1e-5 * normal(rng));
      point.covariance_m2 = covariance;
      point.normal_sigma_rad = 0.0;
    }
    return points;
  };
  expect_the_law(held_in(runs, touch_once), runs);
  // Weights alike for all points are worse off.
  double with = 0.0;
  double without = 0.0;
  for (int run = 0; run < runs; ++run) {
    std::vector<GivenPoint> points = touch_once();
    const auto squared_error = [&] {
      return std::pow(fit_given_class(CurveClass::Ellipse, points).shape.values[1] - 0.02, 2);
    };
    with += squared_error();
    for (GivenPoint& point : points) {
      point.covariance_m2.setZero();
      point.sigma_m = std::sqrt(0.5 * (covariance.x() + covariance.z()));
    }
    without += squared_error();
  }
  EXPECT_LT(with, without);
}

}  // namespace
}  // namespace palpate
