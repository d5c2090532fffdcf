#include "core/recognition/samples/sample_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

ContactSample at(double x, double y = 0.0, double sigma = 0.0) { return {{x, y}, sigma, 0}; }

TEST(SampleMemory, RefusesWhatIsNoSampleAndCountsIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  SampleMemory memory;
  const std::vector<ContactSample> samples = {
      at(0.0), at(nan), at(1.0, inf), at(1.0, 0.0, nan), at(1.0, 0.0, -1.0), at(0.0), at(2.0)};
  const AddResult result = memory.add({}, samples);
  EXPECT_EQ(result.accepted, 2U);
  EXPECT_EQ(result.rejected_not_finite, 3U);
  EXPECT_EQ(result.rejected_negative_sigma, 1U);
  EXPECT_EQ(result.repeated, 1U);
  EXPECT_EQ(memory.sample_count(), 2U);
}

TEST(SampleMemory, PatchesAreKeptApartAndBounded) {
  MemoryOptions options;
  options.most_patches = 3;
  SampleMemory memory(options);
  for (std::uint32_t patch = 0; patch < 5; ++patch) {
    PatchContext context;
    context.patch = patch;
    const std::vector<ContactSample> samples = {at(patch), at(patch + 0.5)};
    memory.add(context, samples);
  }
  ASSERT_EQ(memory.patches().size(), 3U);
  EXPECT_EQ(memory.patches().front().context.patch, 2U);
  EXPECT_EQ(memory.stored_count(), 6U);
}

TEST(SampleMemory, ThePatchThatGrowsIsNotForgottenHoweverOld) {
  MemoryOptions options;
  options.most_patches = 2;
  SampleMemory memory(options);
  const auto add = [&](std::uint32_t patch, std::vector<ContactSample> samples) {
    PatchContext context;
    context.patch = patch;
    return memory.add(context, samples);
  };
  add(0, {at(0.0)});
  add(1, {at(10.0), at(11.0), at(12.0)});
  add(2, {at(20.0), at(21.0)});
  const AddResult result = add(0, {at(1.0), at(2.0), at(3.0)});
  EXPECT_EQ(result.accepted, 3U);
  EXPECT_EQ(result.forgotten, 3U);
  ASSERT_EQ(memory.patches().size(), 2U);
  EXPECT_EQ(memory.patches().front().context.patch, 0U);
  EXPECT_EQ(memory.patches().front().samples.size(), 4U);
}

TEST(SampleMemory, TouchesAloneAreBoundedApartFromStrokes) {
  MemoryOptions options;
  options.most_patches = 1;
  options.most_lone_touches = 16;
  SampleMemory memory(options);
  std::size_t forgotten = 0;
  for (std::uint32_t touch = 0; touch < 20; ++touch) {
    PatchContext context;
    context.patch = touch;
    const ContactSample sample = at(touch);
    forgotten += memory.add(context, {&sample, 1}).forgotten;
  }
  EXPECT_EQ(memory.patches().size(), 16U);
  EXPECT_EQ(memory.patches().front().context.patch, 4U);
  EXPECT_EQ(forgotten, 4U);
  EXPECT_EQ(memory.sample_count() + forgotten, 20U);
}

TEST(SampleMemory, LongPatchesAreMergedWithoutLosingContactsAndWithTheBiasStated) {
  MemoryOptions options;
  options.most_samples_per_patch = 64;
  SampleMemory memory(options);
  constexpr int kSamples = 1000;
  std::vector<ContactSample> samples;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 1e-3 * i;
    samples.push_back(at(std::cos(angle), std::sin(angle), 1e-5));
  }
  EXPECT_EQ(memory.add({}, samples).accepted, 1000U);
  EXPECT_EQ(memory.sample_count(), 1000U);
  EXPECT_LE(memory.stored_count(), 64U);
  const StoredPatch& patch = memory.patches().front();
  double farthest = 0.0;
  for (const StoredSample& sample : patch.samples) {
    EXPECT_NEAR(sample.sigma_m, 1e-5, 1e-18);
    farthest = std::max(farthest, std::abs(sample.position_m.norm() - 1.0));
  }
  EXPECT_GT(farthest, 0.0);
  // Biases of the merges add up as 1 + 1/4 + 1/16 + ...: a third more than the last one's.
  EXPECT_LE(farthest, 1.5 * patch.merge_bias_m);
}

}  // namespace
}  // namespace palpate
