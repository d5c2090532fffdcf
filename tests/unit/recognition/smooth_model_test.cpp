#include "core/recognition/smooth/smooth_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/recognition/fit/on_all_points.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

test::Scene scene_of(CurveClass curve_class, std::mt19937_64& rng) {
  test::SceneOptions options;
  options.patches = 2;
  return test::random_scene(curve_class, options, rng);
}

TEST(SmoothModel, LeavesNoiseAloneWhateverTheClass) {
  std::mt19937_64 rng = test::test_rng();
  double chi2 = 0.0;
  double dof = 0.0;
  for (const CurveClass curve_class : kCurveClasses) {
    for (int i = 0; i < 20; ++i) {
      const test::Scene scene = scene_of(curve_class, rng);
      FitData data = test::fit_data(scene, scene.sigma_m);
      const SmoothModel model = fit_smooth_model(&data, true);
      EXPECT_LT(model.reduced.points.size(), data.points.size() / 3);
      chi2 += model.chi2;
      dof += model.dof();
    }
  }
  // Choosing the degree by the data takes a little more than its parameters' share of the noise:
  // within 3 % of one per degree of freedom over the 160 scenes.
  EXPECT_NEAR(chi2 / dof, 1.0, 0.03);
}

TEST(SmoothModel, ReducedPointsTellWhatAllPointsTell) {
  // chi2 of a class on all points = chi2 of the smooth model + chi2 on the reduced points. Fits of
  // the true class differ by what two more degrees of each section's polynomial hold of noise.
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    for (int i = 0; i < 10; ++i) {
      const test::Scene scene = scene_of(curve_class, rng);
      FitData data = test::fit_data(scene, scene.sigma_m);
      const SmoothModel model = fit_smooth_model(&data, true);
      const ClassFits fits = fit_classes(model.reduced);
      const auto& fit = fits[static_cast<std::size_t>(curve_class)];
      ASSERT_TRUE(fit.has_value());
      if (fit->at_limit) {
        continue;
      }
      const auto refined = refine_on_all(settled(*fit, model.reduced), model, data);
      if (!refined) {
        continue;  // straight points: no such conic
      }
      EXPECT_NEAR(refined->chi2, fit->chi2 + model.chi2, 1.0 + 0.02 * model.chi2)
          << name_of(curve_class);
    }
  }
}

TEST(SmoothModel, TangentsFollowTravel) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = scene_of(CurveClass::Ellipse, rng);
  FitData data = test::fit_data(scene, scene.sigma_m);
  fit_smooth_model(&data, true);
  for (const PatchSpan& patch : data.patches) {
    for (std::size_t i = patch.begin + 5; i + 5 < patch.end; ++i) {
      const Vec2 chord = data.points[i + 5].position - data.points[i - 5].position;
      EXPECT_GT(data.points[i].tangent.dot(chord.normalized()), 0.9);
    }
  }
}

}  // namespace
}  // namespace palpate
