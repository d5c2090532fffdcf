// Sections: where patches are cut, and what is kept from one smoothing to the next.
#include "core/recognition/smooth/patch_sections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/recognition/smooth/smooth_model.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Two strokes of a scene, the second up to a share of it.
std::vector<StoredPatch> touched(const test::Scene& scene, double sigma_m, double share) {
  std::vector<StoredPatch> patches = test::stored_patches(scene, sigma_m);
  auto& samples = patches.back().samples;
  samples.resize(static_cast<std::size_t>(share * static_cast<double>(samples.size())));
  return patches;
}

FitData data_of(const std::vector<StoredPatch>& patches) { return make_fit_data(patches, 0.0); }

/// Coordinates are of size 1, and chords as short as a tenth of that lose a digit.
constexpr double kRounding = 1e-12;

void expect_same(const SmoothModel& kept, const SmoothModel& anew) {
  EXPECT_NEAR(kept.chi2, anew.chi2, 1e-9 * anew.chi2);
  EXPECT_EQ(kept.parameters, anew.parameters);
  EXPECT_EQ(kept.nearest_reduced, anew.nearest_reduced);
  ASSERT_EQ(kept.reduced.points.size(), anew.reduced.points.size());
  for (std::size_t i = 0; i < anew.reduced.points.size(); ++i) {
    const FitPoint& a = kept.reduced.points[i];
    const FitPoint& b = anew.reduced.points[i];
    EXPECT_LT((a.position - b.position).norm(), kRounding);
    EXPECT_LT((a.tangent - b.tangent).norm(), 10.0 * kRounding);
    EXPECT_NEAR(a.inverse_sigma, b.inverse_sigma, 1e-9 * b.inverse_sigma);
  }
}

std::vector<std::size_t> sizes_of_sections(const FitData& data) {
  std::vector<std::size_t> sizes;
  for (const Section& section : sections_of_patches(data, {.known = true})) {
    sizes.push_back(section.points.size());
  }
  return sizes;
}

TEST(Sections, AreTheSameWhicheverWayAPathIsTravelled) {
  std::mt19937_64 rng = test::test_rng();
  int cut = 0;
  for (const CurveClass curve_class : kCurveClasses) {
    for (const int samples : {60, 111, 112, 400}) {
      test::SceneOptions options;
      options.patches = 1;
      options.points_per_patch = samples;
      options.least_fraction = 0.3;
      options.most_fraction = 1.0;
      options.sigma_over_size = 1e-4;
      const test::Scene scene = test::random_scene(curve_class, options, rng);
      std::vector<StoredPatch> patches = test::stored_patches(scene, scene.sigma_m);
      const std::vector<std::size_t> along = sizes_of_sections(data_of(patches));
      std::reverse(patches[0].samples.begin(), patches[0].samples.end());
      std::vector<std::size_t> against = sizes_of_sections(data_of(patches));
      std::reverse(against.begin(), against.end());
      EXPECT_EQ(along, against) << name_of(curve_class) << ' ' << samples;
      cut += along.size() > 1 ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 16);  // half of them: otherwise the test says little
}

TEST(KeptSections, OfAnUnchangedPatchAreThoseOfASmoothingInAnotherFrame) {
  std::mt19937_64 rng = test::test_rng();
  for (const bool sigma_known : {true, false}) {
    for (const CurveClass curve_class : kCurveClasses) {
      const test::Scene scene = test::random_scene(curve_class, {}, rng);
      const double sigma_m = sigma_known ? scene.sigma_m : 0.0;
      KeptSections kept;
      const std::vector<StoredPatch> before = touched(scene, sigma_m, 0.6);
      FitData first = data_of(before);
      fit_smooth_model(&first, sigma_known, StatedNoise::MayBeTooLow, {before, &kept});

      const std::vector<StoredPatch> now = touched(scene, sigma_m, 1.0);
      FitData by_kept = data_of(now);
      FitData by_none = by_kept;
      ASSERT_NE(by_kept.scale, first.scale);
      EXPECT_TRUE(kept.of(0, now[0], by_kept, sigma_known));
      EXPECT_FALSE(kept.of(1, now[1], by_kept, sigma_known));
      const SmoothModel model =
          fit_smooth_model(&by_kept, sigma_known, StatedNoise::MayBeTooLow, {now, &kept});
      expect_same(model, fit_smooth_model(&by_none, sigma_known));
      EXPECT_TRUE(kept.of(1, now[1], by_kept, sigma_known));
    }
  }
}

TEST(KeptSections, AreNotThoseOfOtherSamplesOrAnotherNoise) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = test::random_scene(CurveClass::Ellipse, {}, rng);
  const std::vector<StoredPatch> patches = touched(scene, scene.sigma_m, 1.0);
  KeptSections kept;
  FitData data = data_of(patches);
  fit_smooth_model(&data, true, StatedNoise::MayBeTooLow, {patches, &kept});
  ASSERT_TRUE(kept.of(0, patches[0], data, true));
  EXPECT_FALSE(kept.of(0, patches[0], data, false));
  EXPECT_FALSE(kept.of(0, patches[1], data, true));

  std::vector<StoredPatch> moved = patches;
  moved[0].samples[7].position_m.x() += scene.sigma_m;
  EXPECT_FALSE(kept.of(0, moved[0], data_of(moved), true));

  std::vector<StoredPatch> noisier = patches;
  noisier[0].samples[7].sigma_m *= 2.0;
  EXPECT_FALSE(kept.of(0, noisier[0], data_of(noisier), true));

  // The noise of all samples by one factor, as a path tells it where nobody states it.
  FitData scaled = data;
  FitData uneven = data;
  for (FitPoint& point : scaled.points) {
    point.inverse_sigma *= 3.0;
  }
  uneven.points[7].inverse_sigma *= 3.0;
  const auto of_scaled = kept.of(0, patches[0], scaled, true);
  ASSERT_TRUE(of_scaled);
  EXPECT_FALSE(kept.of(0, patches[0], uneven, true));
  EXPECT_NEAR(of_scaled->front().chi2(), 9.0 * kept.of(0, patches[0], data, true)->front().chi2(),
              1e-9 * of_scaled->front().chi2());
}

TEST(KeptSections, AreNotKeptOfAPatchWithSamplesSetAside) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = test::random_scene(CurveClass::Circle, {}, rng);
  const std::vector<StoredPatch> patches = touched(scene, scene.sigma_m, 1.0);
  const FitData all = data_of(patches);
  std::vector<bool> is_out(all.points.size(), false);
  is_out[5] = true;
  FitData fewer = without_points(all, is_out);
  KeptSections kept;
  fit_smooth_model(&fewer, true, StatedNoise::MayBeTooLow, {patches, &kept});
  EXPECT_FALSE(kept.of(0, patches[0], all, true));
  EXPECT_TRUE(kept.of(1, patches[1], all, true));
}

}  // namespace
}  // namespace palpate
