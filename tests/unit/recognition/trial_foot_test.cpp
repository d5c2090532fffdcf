// Feet on trial curves against those to full precision.
#include "core/recognition/modes/trial_foot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <variant>

#include "core/recognition/modes/mode_search.h"
#include "tests/support/random_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

TrialFoot trial_foot_of(const Curve& curve, const Vec2& point, double t, double sigma) {
  return std::visit([&](const auto& c) { return trial_foot(c, point, t, sigma); }, curve);
}

/// Off the curve along its normal, as residuals are.
double across(const TrialFoot& foot, const Vec2& point) {
  return cross(foot.first.normalized(), point - foot.position);
}

class TrialFootOf : public testing::TestWithParam<CurveClass> {};

/// What a residual of one deviation may be off: the potential then changes by half of what settles
/// a descent (kSettledPotential).
constexpr double kSeen = 0.5 * kSettledPotential;

TEST_P(TrialFootOf, TellsTheDistanceToAHundredthOfTheNoise) {
  std::mt19937_64 rng = test::test_rng();
  for (const double sigma_over_size : {1e-3, 1e-5, 1e-7}) {
    for (int i = 0; i < 20; ++i) {
      test::SceneOptions options;
      options.sigma_over_size = sigma_over_size;
      const test::Scene scene = test::random_scene(GetParam(), options, rng);
      const Curve curve = *make_curve(scene.curve_class, scene.values);
      for (std::size_t p = 0; p < scene.patches.size(); ++p) {
        for (std::size_t k = 0; k < scene.t[p].size(); ++k) {
          const Vec2 point = scene.world_T_curve.inverse() * scene.patches[p][k];
          const double start = scene.t[p][k];
          const TrialFoot foot = trial_foot_of(curve, point, start, scene.sigma_m);
          EXPECT_NEAR(across(foot, point), foot_point_near(curve, point, start).distance,
                      kSeen * scene.sigma_m)
              << scene.values.transpose() << ", t " << start;
        }
      }
    }
  }
}

/// A fit on the way may lie far from the points: what it tells of them is still true.
TEST_P(TrialFootOf, IsAFootFarFromTheCurveToo) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 20; ++i) {
    test::SceneOptions options;
    options.sigma_over_size = 0.03;
    const test::Scene scene = test::random_scene(GetParam(), options, rng);
    const Curve curve = *make_curve(scene.curve_class, scene.values);
    const double sigma = 1e-5 * scene.sigma_m;
    for (std::size_t k = 0; k < scene.t[0].size(); ++k) {
      const Vec2 point = scene.world_T_curve.inverse() * scene.patches[0][k];
      const TrialFoot foot = trial_foot_of(curve, point, scene.t[0][k], sigma);
      EXPECT_LT((foot.position - position(curve, foot.t)).norm(), 1e-3 * sigma);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, TrialFootOf, testing::ValuesIn(kCurveClasses),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

TEST(TrialFoot, OfAnEllipsesCentreIsOnIt) {
  const TrialFoot foot =
      trial_foot_of(*make_curve(CurveClass::Ellipse, {3.0, 2.0, 0.0}), Vec2::Zero(), 0.7, 1e-3);
  EXPECT_TRUE(std::isfinite(foot.t));
  EXPECT_TRUE(foot.position.allFinite());
}

}  // namespace
}  // namespace palpate
