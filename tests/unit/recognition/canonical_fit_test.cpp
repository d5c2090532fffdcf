#include "core/recognition/fit/canonical_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/curves/curve.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/smooth/smooth_model.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

class CanonicalFitOf : public testing::TestWithParam<CurveClass> {};

TEST_P(CanonicalFitOf, ExactPointsGiveShapeAndPoseBack) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.patches = 2;
  options.least_fraction = 0.2;
  options.most_fraction = 0.4;
  options.sigma_over_size = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    const test::Scene scene = test::random_scene(GetParam(), options, rng);
    const double sigma_m = 1e-7;
    FitData data = test::fit_data(scene, sigma_m);
    const SmoothModel smooth = fit_smooth_model(&data, true);
    const ClassFits fits = fit_classes(smooth.reduced, test::unbounded_work());
    const auto refined =
        refine_on_all(settled(*fits[static_cast<std::size_t>(GetParam())], smooth.reduced,
                              RivalOf::Best, test::unbounded_work()),
                      smooth, data, kOnAllEffort, test::unbounded_work());
    ASSERT_TRUE(refined.has_value());
    const auto polished = polish(*refined, data, test::unbounded_work());
    ASSERT_TRUE(polished.has_value());
    const auto canonical = to_canonical(*polished, data);
    ASSERT_TRUE(canonical.has_value());
    // Every sample lies on the curve so placed, where it is said to lie, to the fit's own
    // precision.
    const auto curve = make_curve(canonical->shape.curve_class, canonical->shape.values);
    ASSERT_TRUE(curve.has_value());
    std::size_t i = 0;
    double worst = 0.0;
    for (const auto& patch : scene.patches) {
      for (const Vec2& sample : patch) {
        const Vec2 placed = canonical->world_T_curve * position(*curve, canonical->points[i++].t);
        worst = std::max(worst, (placed - sample).norm());
      }
    }
    EXPECT_LT(worst, 1e-8) << trial << " " << scene.values.transpose();
    Hypothesis hypothesis;
    hypothesis.shape = canonical->shape;
    hypothesis.world_T_curve = canonical->world_T_curve;
    const Eigen::VectorXd error = test::error_of(hypothesis, scene);
    const bool free_turn = pose_symmetry(GetParam()) == 0;
    const Eigen::Index compared = GetParam() == CurveClass::Line ? 0
                                  : free_turn                    ? error.size() - 1
                                                                 : error.size();
    for (Eigen::Index k = 0; k < compared; ++k) {
      // Within the error that residuals of a tenth of the stated sigma can cause.
      EXPECT_LE(std::abs(error[k]), 0.1 * std::sqrt(canonical->covariance(k, k)) + 1e-12)
          << trial << " " << k;
    }
  }
}

TEST_P(CanonicalFitOf, CovarianceIsPositiveAndScalesWithTheNoise) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  const test::Scene scene = test::random_scene(GetParam(), options, rng);
  const auto covariance_for = [&](double factor) {
    FitData data = test::fit_data(scene, factor * scene.sigma_m);
    const SmoothModel smooth = fit_smooth_model(&data, true);
    const ClassFits fits = fit_classes(smooth.reduced, test::unbounded_work());
    const auto refined =
        refine_on_all(settled(*fits[static_cast<std::size_t>(GetParam())], smooth.reduced,
                              RivalOf::Best, test::unbounded_work()),
                      smooth, data, kOnAllEffort, test::unbounded_work());
    return to_canonical(*refined, data)->covariance;
  };
  const ShapePoseCovariance one = covariance_for(1.0);
  const ShapePoseCovariance two = covariance_for(2.0);
  EXPECT_LE((one - one.transpose()).cwiseAbs().maxCoeff(), 1e-12 * one.cwiseAbs().maxCoeff());
  for (Eigen::Index k = 0; k < one.rows(); ++k) {
    EXPECT_GE(one(k, k), 0.0);
    if (one(k, k) > 0.0) {
      EXPECT_NEAR(two(k, k) / one(k, k), 4.0, 0.2);
    }
  }
}

TEST(CanonicalFit, ALineHasNoVarianceAlongItselfHoweverItLies) {
  constexpr double kSigma_m = 1e-5;
  for (const double theta : {0.0, 1e-17, 1e-9, 1e-4, 0.5, 0.5 * kPi, 3.0}) {
    const Vec2 along(std::cos(theta), std::sin(theta));
    test::Scene scene;
    scene.patches.resize(2);
    for (int i = 0; i < 60; ++i) {
      const double across_m = (i % 3 - 1) * kSigma_m;  // no fit without residuals
      for (const int patch : {0, 1}) {
        scene.patches[static_cast<std::size_t>(patch)].push_back(
            Vec2(0.2, 0.1) + (0.05 * patch + 5e-4 * i) * along + across_m * left_of(along));
      }
    }
    FitData data = test::fit_data(scene, kSigma_m);
    const SmoothModel smooth = fit_smooth_model(&data, true);
    const ClassFits fits = fit_classes(smooth.reduced, test::unbounded_work());
    const auto& line = fits[static_cast<std::size_t>(CurveClass::Line)];
    ASSERT_TRUE(line.has_value()) << theta;
    const auto canonical = to_canonical(*line, smooth.reduced);
    ASSERT_TRUE(canonical.has_value()) << theta;
    const Eigen::Matrix2d place = canonical->covariance.topLeftCorner<2, 2>();
    // Of 120 samples the place across is known to sigma / sqrt(120), at their mean.
    const double across_m2 = left_of(along).dot(place * left_of(along));
    EXPECT_NEAR(std::sqrt(120.0 * across_m2), kSigma_m, 0.1 * kSigma_m) << theta;
    EXPECT_LT(along.dot(place * along), 1e-6 * across_m2) << theta;
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, CanonicalFitOf, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
