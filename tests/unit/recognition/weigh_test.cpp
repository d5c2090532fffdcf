#include "core/recognition/weigh/weigh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/weigh/near_best.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

/// Scenes of a class over the noise levels at which the reduced points follow and do not follow.
template <typename Function>
void for_each_scene(CurveClass curve_class, const Function& function) {
  std::mt19937_64 rng = test::test_rng();
  for (const double level : {1e-8, 1e-5, 1e-3}) {
    for (int i = 0; i < test::stress_count(20); ++i) {
      test::SceneOptions options;
      options.patches = 1 + i % 3;
      options.sigma_over_size = level;
      function(test::random_scene(curve_class, options, rng));
    }
  }
}

class WeighingOf : public testing::TestWithParam<CurveClass> {};

TEST_P(WeighingOf, WhatIsPublishedIsRefinedOnAllPoints) {
  for_each_scene(GetParam(), [](const test::Scene& scene) {
    for (const bool sigma_known : {true, false}) {
      FitData data = test::fit_data(scene, sigma_known ? scene.sigma_m : 1.0);
      data.noise_is_stated = sigma_known;
      const Weighing w = weigh(std::move(data), {}, test::unbounded_work());
      const auto best = static_cast<std::size_t>(w.best);
      if (w.fits[best]) {
        EXPECT_TRUE(w.fits[best]->on_all || w.fits[best]->at_limit);
      }
      for (std::size_t i = 0; i < w.fits.size(); ++i) {
        if (!w.canonical[i]) {
          continue;
        }
        // No shape of what is no such curve; a point for each that the fit saw.
        EXPECT_FALSE(w.fits[i]->at_limit);
        EXPECT_TRUE(std::isfinite(w.fits[i]->chi2));
        EXPECT_EQ(w.canonical[i]->points.size(),
                  w.fits[i]->on_all ? w.data.points.size() : w.smooth.reduced.points.size());
      }
    }
  });
}

TEST_P(WeighingOf, ChiSquareIsThatOfTheOptimumOnAllPoints) {
  // Of the true class, which every scene leaves plausible.
  int compared = 0;
  for_each_scene(GetParam(), [&](const test::Scene& scene) {
    FitData data = test::fit_data(scene, scene.sigma_m);
    const SmoothModel smooth = fit_smooth_model(&data, true);
    const ClassFits fits = fit_classes(smooth.reduced, test::unbounded_work());
    const auto& fit = fits[static_cast<std::size_t>(GetParam())];
    if (!fit || fit->at_limit) {
      return;
    }
    const ClassFit coarse = settled(*fit, smooth.reduced, RivalOf::Best, test::unbounded_work());
    const auto refined = refine_on_all(coarse, smooth, data, kOnAllEffort, test::unbounded_work());
    const double told = coarse.chi2 + smooth.chi2;
    const double on_all = chi2_on_all(coarse, smooth, data, test::unbounded_work());
    // Where the two agree, as weigh() asks, the optimum is nowhere else.
    if (refined && std::abs(on_all - told) <= 1.0 && std::abs(told - refined->chi2) <= 4.0) {
      EXPECT_NEAR(on_all, refined->chi2, 2.0);
      ++compared;
    }
  });
  EXPECT_GT(compared, 0);
}

INSTANTIATE_TEST_SUITE_P(AllClasses, WeighingOf, testing::ValuesIn(kCurveClasses),
                         [](const auto& param_info) {
                           return std::string(name_of(param_info.param));
                         });

// Where a fit cannot be held in canonical coordinates, the prior may have led to a mode of the
// class all the same.
TEST(NearBest, AClassThatIsPlacedNowhereHasNoPartsNearIt) {
  const Arcs arcs;
  const FitData reduced;
  const EvidenceContext context{arcs, reduced, test::unbounded_work(), {}, 0.0};
  constexpr auto kBest = CurveClass::CubicSpline;
  Contenders contenders;
  contenders.coarse[kBest].emplace().curve_class = kBest;
  contenders.fits[kBest] = contenders.coarse[kBest];
  contenders.evidences.classes[kBest].emplace();
  EXPECT_EQ(log_evidence_near_best(kBest, 0.0, kNoEvidence, contenders, context), kNoEvidence);
}

}  // namespace
}  // namespace palpate
