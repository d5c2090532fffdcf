// A given class whose points allow several curves, or one in a wide bent valley: what is told as
// known holds the truth.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/numerics/probability/chi_square.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/verdict/determined.h"
#include "tests/support/calibration.h"
#include "tests/support/random_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct Scene {
  Curve curve;
  Pose2 world_T_curve;
  std::vector<GivenPoint> points;
};

/// Touches at random places between two parameters, the tip right of increasing t.
Scene touched(const Curve& curve, const Vec2& range, int count, double sigma_m, double tip_radius_m,
              std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Scene scene{curve, {0.6 * uniform(rng) - 0.3, 0.6 * uniform(rng) - 0.3, kPi * uniform(rng)}, {}};
  for (int i = 0; i < count; ++i) {
    const double t = range[0] + (range[1] - range[0]) * uniform(rng);
    const Vec2 out = -left_of(derivatives(curve, t).first).normalized();
    GivenPoint& point = scene.points.emplace_back();
    point.position_m = scene.world_T_curve * (position(curve, t) + tip_radius_m * out) +
                       sigma_m * Vec2(normal(rng), normal(rng));
    point.sigma_m = sigma_m;
    point.tip_radius_m = tip_radius_m;
  }
  return scene;
}

/// How probable the curve told is beside its rival; none if it is not told as known, by the
/// recognizer's limits.
std::optional<double> told_with(const GivenFit& fit, const Scene& scene) {
  const RecognizerOptions options;
  Vec2 low = scene.points.front().position_m;
  Vec2 high = low;
  for (const GivenPoint& point : scene.points) {
    low = low.cwiseMin(point.position_m);
    high = high.cwiseMax(point.position_m);
  }
  if (fit.status != GivenStatus::Fitted || !fit.bounded ||
      !is_determined(fit.shape, fit.covariance, 0.5 * (high - low).maxCoeff(),
                     options.determined_fraction)) {
    return std::nullopt;
  }
  const double odds = fit.rival ? fit.rival->log_odds : 1e3;
  if (odds <= log_odds(options.recognized_probability)) {
    return std::nullopt;
  }
  return 1.0 / (1.0 + std::exp(-odds));
}

constexpr double kOutside = 1e-4;  ///< of the truths, by chance

bool holds(const GivenFit& fit, const Scene& scene) {
  const Eigen::Index n = fit.covariance.rows();
  Eigen::VectorXd error(n);
  error.head(n - 3) = fit.shape.values.head(n - 3) - parameters(scene.curve).head(n - 3);
  error[n - 3] = fit.world_T_curve.x - scene.world_T_curve.x;
  error[n - 2] = fit.world_T_curve.y - scene.world_T_curve.y;
  error[n - 1] = std::remainder(fit.world_T_curve.theta - scene.world_T_curve.theta,
                                2.0 * kPi / pose_symmetry(class_of(scene.curve)));
  const Eigen::VectorXd scale = fit.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * fit.covariance * scale.asDiagonal();
  const Eigen::VectorXd u = scale.asDiagonal() * error;
  return u.dot(unit.ldlt().solve(u)) <= chi_square_threshold(kOutside, static_cast<int>(n));
}

struct Told {
  int known = 0;
  int held = 0;
  std::vector<double> probabilities;
};

void count(const Scene& scene, Told* told) {
  const CurveClass curve_class = class_of(scene.curve);
  const GivenFit fit = fit_given_class(curve_class, scene.points);
  if (const auto probability = told_with(fit, scene)) {
    ++told->known;
    told->held += holds(fit, scene) ? 1 : 0;
    told->probabilities.push_back((1.0 - kOutside) * *probability);
  }
}

void expect_to_hold(const Told& told, int at_least_known) {
  EXPECT_GE(told.known, at_least_known);
  if (!test::counts_tell()) return;
  EXPECT_GE(told.held, test::binomial_band(told.probabilities, 1.0 - 2e-4).least);
}

// An arm of a semi-cubical parabola is nearly one of another that opens the other way.
TEST(GivenTwins, OneArmOfASemiCubicalParabolaIsToldOnlyIfItIsKnown) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Told told;
  const int scenes = test::stress_count(60);
  for (int i = 0; i < scenes; ++i) {
    const SemiCubicalParabola curve{2.0 + 8.0 * uniform(rng), 0.8 * uniform(rng) - 0.4};
    const Vec2 range(0.03 + 0.03 * uniform(rng), 0.12 + 0.06 * uniform(rng));
    const double sigma_m = std::array{1e-6, 1e-5, 1e-4}[static_cast<std::size_t>(i % 3)];
    const int touches = std::array{6, 12, 24, 60}[static_cast<std::size_t>(i % 4)];
    count(touched(curve, range, touches, sigma_m, 0.0, rng), &told);
  }
  // Two thirds of the scenes have a noise below a thousandth of their size.
  expect_to_hold(told, scenes / 10);
}

/// The samples of a random scene, in strokes.
Scene stroked(const test::Scene& random) {
  Scene scene{*make_curve(random.curve_class, random.values), random.world_T_curve, {}};
  for (std::size_t p = 0; p < random.patches.size(); ++p) {
    for (const Vec2& place : random.patches[p]) {
      GivenPoint& point = scene.points.emplace_back();
      point.position_m = place;
      point.sigma_m = random.sigma_m;
      point.stroke = p + 1;
    }
  }
  return scene;
}

// Where the noise is half a percent of the part, a cusp laid over it explains some of it.
TEST(GivenTwins, StrokesWithCoarseNoiseAreNoNarrowCusp) {
  auto rng = test::test_rng();
  Told told;
  const int scenes = test::stress_count(120);
  for (int i = 0; i < scenes; ++i) {
    test::SceneOptions options;
    options.patches = 2 + i % 2;
    options.points_per_patch = 111;
    options.sigma_over_size = test::log_uniform(rng, 0.003, 0.01);
    count(stroked(test::random_scene(CurveClass::SemiCubicalParabola, options, rng)), &told);
  }
  expect_to_hold(told, scenes / 4);
}

// Of few touches on a short arc the linear covariance is too small.
TEST(GivenTwins, AShortArcOfAnEllipseIsToldOnlyIfItIsKnown) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Told told;
  const int scenes = test::stress_count(300);
  for (int i = 0; i < scenes; ++i) {
    const double a = 0.01 + 0.05 * uniform(rng);
    const double from = 2.0 * kPi * uniform(rng);
    const Vec2 range(from, from + kPi / 3.0 * (1.0 + 2.0 * uniform(rng)));
    const double sigma_m = std::array{3e-6, 1e-5, 1e-4}[static_cast<std::size_t>(i % 3)];
    const int touches = std::array{5, 6, 8, 80}[static_cast<std::size_t>(i % 4)];
    const Ellipse curve{a, a * (0.3 + 0.6 * uniform(rng))};
    count(touched(curve, range, touches, sigma_m, 0.0, rng), &told);
  }
  expect_to_hold(told, scenes / 10);
}

// Through four points of a parabola goes another one: they are the corners of a convex polygon.
TEST(GivenTwins, FourPointsLieOnTwoParabolas) {
  auto rng = test::test_rng();
  for (int i = 0; i < 40; ++i) {
    Scene scene = touched(Parabola{0.01}, {-1.5, 1.5}, 4, 0.0, 0.0, rng);
    for (GivenPoint& point : scene.points) point.sigma_m = 1e-7;
    const GivenFit fit = fit_given_class(CurveClass::Parabola, scene.points);
    ASSERT_EQ(fit.status, GivenStatus::Fitted) << i;
    ASSERT_TRUE(fit.rival.has_value()) << i;
    EXPECT_NEAR(fit.rival->log_odds, 0.0, 1e-6) << i;
    const double error = std::abs(fit.shape.values[0] - 0.01);
    const double of_rival = std::abs(fit.rival->shape.values[0] - 0.01);
    EXPECT_LT(std::min(error, of_rival), 1e-9) << i;
  }
}

// Half a turn leaves a cubical parabola the same and exchanges its sides: that is no other curve.
TEST(GivenTwins, NormalsTellTheSideOfACubicalParabola) {
  auto rng = test::test_rng();
  constexpr double kTip_m = 0.002;
  Scene scene = touched(CubicalParabola{290.0, 0.27}, {-0.027, 0.023}, 12, 1e-5, kTip_m, rng);
  for (GivenPoint& point : scene.points) {
    const Vec2 local = scene.world_T_curve.to_local(point.position_m);
    const FootPoint foot = foot_point(scene.curve, local);
    point.normal = scene.world_T_curve.rotate(local - foot.position);
    point.normal_sigma_rad = 0.02;
  }
  const GivenFit fit = fit_given_class(CurveClass::CubicalParabola, scene.points);
  ASSERT_TRUE(told_with(fit, scene).has_value());
  EXPECT_TRUE(holds(fit, scene));
  EXPECT_FALSE(fit.rival.has_value());
  for (GivenPoint& point : scene.points) point.normal *= -1.0;
  const GivenFit turned = fit_given_class(CurveClass::CubicalParabola, scene.points);
  // The surface lies on the other side of the same centres.
  const Vec2 away = turned.world_T_curve.translation() - fit.world_T_curve.translation();
  EXPECT_GT(away.norm(), kTip_m);
}

// A curve that fits thousands of times worse is no answer because the search has come to an end
// there: the part would seem to be none of its class.
TEST(GivenTwins, NoMinimumIsToldThatTheNoiseExcludes) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int scenes = test::stress_count(16);
  for (int i = 0; i < scenes; ++i) {
    const double from = 2.0 * uniform(rng) - 1.0;
    const double part = 0.1 + 0.3 * uniform(rng);
    const double start = 0.173 + 0.087 * (1.0 - part) * uniform(rng);
    for (const Scene& scene :
         {touched(Hyperbola{0.01 + 0.02 * uniform(rng), 0.01 + 0.01 * uniform(rng)},
                  {from, from + part}, 80, 3e-6, 0.0, rng),
          touched(SemiCubicalParabola{5.77, 0.0}, {start, start + 0.087 * part}, 80, 1e-6, 0.0,
                  rng)}) {
      const CurveClass curve_class = class_of(scene.curve);
      SCOPED_TRACE(name_of(curve_class));
      const GivenFit fit = fit_given_class(curve_class, scene.points);
      if (fit.status != GivenStatus::AtLimit && fit.status != GivenStatus::Unfinished) {
        ASSERT_EQ(fit.status, GivenStatus::Fitted);
        // The true curve has chi-square of one degree of freedom per touch, the best one less. A
        // minimum may be preferred to a valley by three deviations.
        EXPECT_LT(fit.chi2,
                  chi_square_threshold(1e-6, static_cast<int>(scene.points.size())) + 9.0);
      }
      if (told_with(fit, scene)) {
        EXPECT_TRUE(holds(fit, scene));
      }
    }
  }
}

double chi2_of_truth(const Scene& scene) {
  double sum = 0.0;
  for (const GivenPoint& point : scene.points) {
    const Vec2 local = scene.world_T_curve.to_local(point.position_m);
    const double deviations = foot_point(scene.curve, local).distance / point.sigma_m;
    sum += deviations * deviations;
  }
  return sum;
}

// Of a part that is far longer than wide, a valley over the axis's direction is as narrow as the
// part is slim. A curve that fits worse than the true one is not that of least squares.
TEST(GivenTwins, ASlimCubicalParabolaIsFoundInItsNarrowValley) {
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int scenes = test::stress_count(150);
  int fitted = 0;
  for (int i = 0; i < scenes; ++i) {
    const double part = 0.3 + 0.7 * uniform(rng);
    const double from = 0.015 * (2.0 * (1.0 - part) * uniform(rng) - 1.0);
    const CubicalParabola curve{test::log_uniform(rng, 3e4, 3e5), 0.0};
    const Scene scene = touched(curve, {from, from + 0.03 * part}, 60, 1e-5, 0.0, rng);
    const GivenFit fit = fit_given_class(CurveClass::CubicalParabola, scene.points);
    if (fit.status == GivenStatus::Fitted) {
      ++fitted;
      // Beside a valley, a minimum may be preferred by three deviations.
      EXPECT_LT(fit.chi2, chi2_of_truth(scene) + 9.0) << i;
    }
  }
  EXPECT_GE(fitted, scenes / 2);
}

// Any single arm, tip between the arms or outside: the part may end before the other arm begins.
TEST(GivenTwins, ATipMayLieWhereTheOtherArmWouldBe) {
  auto rng = test::test_rng();
  const SemiCubicalParabola curve{2.33, -0.3};
  Scene scene = touched(curve, {0.034, 0.187}, 100, 3e-6, 0.0005, rng);
  for (GivenPoint& point : scene.points) {
    // Right of increasing t: on the side of the other arm, which is nearer near the cusp.
    const Vec2 local = scene.world_T_curve.to_local(point.position_m);
    const FootPoint foot = foot_point_near(scene.curve, local, std::sqrt(local.x()));
    point.normal = scene.world_T_curve.rotate(local - foot.position);
    point.normal_sigma_rad = 0.1;
  }
  const GivenFit fit = fit_given_class(CurveClass::SemiCubicalParabola, scene.points);
  ASSERT_EQ(fit.status, GivenStatus::Fitted);
  EXPECT_EQ(fit.side, -1);
  EXPECT_TRUE(holds(fit, scene));
}

}  // namespace
}  // namespace palpate
