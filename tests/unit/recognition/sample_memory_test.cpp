#include "core/recognition/samples/sample_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/recognition/samples/mean_on_path.h"

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
  EXPECT_EQ(count_samples(memory.patches()), 6U);
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

TEST(SampleMemory, LongPatchesAreMergedWithoutLosingContactsAndStayOnThePath) {
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
  EXPECT_LE(count_samples(memory.patches()), 64U);
  const StoredPatch& patch = memory.patches().front();
  const double step = 1e-3 * patch.contacts_per_sample;
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const StoredSample& sample = patch.samples[i];
    EXPECT_NEAR(sample.sigma_m, 1e-5, 1e-18);
    const double variance = (sample.contacts * sample.contacts - 1.0) * 1e-6 / 12.0;
    EXPECT_NEAR(1.0 - sample.position_m.norm(), 0.5 * variance, variance * step * step);
    // What is left: to the second derivative, a parabola through seven adds 804 / (24 * 42) of the
    // fourth; beyond their middle it is short by the cosine of the way from there, up to four
    // steps. And means lie on a circle that is smaller by step^2 / 24.
    const std::size_t count = patch.samples.size();
    const bool at_end = i < 3 || i + 4 >= count;
    const double of_parabola = 804.0 / (24.0 * 42.0) + 1.0 / 24.0;
    const double left_out = of_parabola + (at_end ? 8.0 : 0.0);
    EXPECT_NEAR(mean_on_path(patch, i).norm(), 1.0, 0.5 * variance * left_out * step * step) << i;
  }
}

SampleDetail normal_to(double angle, double sigma_rad) {
  SampleDetail detail;
  detail.normal = {std::cos(angle), std::sin(angle)};
  detail.normal_sigma_rad = sigma_rad;
  return detail;
}

SampleDetail noise_of(double xx, double xy, double yy) {
  SampleDetail detail;
  detail.covariance_m2 = {xx, xy, yy};
  return detail;
}

TEST(SampleMemory, AProbeThatStandsStillTakesNoRoomFromItsStroke) {
  // 300 samples on the way, and 30,000 at its middle: those on the way stay as they came.
  std::mt19937_64 rng(1);
  std::normal_distribution<double> noise(0.0, 1e-5);
  SampleMemory memory;
  std::size_t taken = 0;
  const auto add = [&](double x) {
    const double dx = noise(rng);
    taken += memory.add({}, std::vector{at(x + dx, noise(rng), 1e-5)}).accepted;
  };
  for (int i = 0; i < 150; ++i) add(1e-3 * i);
  for (int i = 0; i < 30000; ++i) add(0.15);
  for (int i = 151; i < 301; ++i) add(1e-3 * i);
  const StoredPatch& patch = memory.patches().front();
  EXPECT_EQ(patch.contacts_per_sample, 1.0);
  EXPECT_EQ(memory.sample_count(), taken);
  EXPECT_EQ(patch.samples.front().contacts, 1.0);
  EXPECT_EQ(patch.samples.back().contacts, 1.0);
  std::size_t on_the_way = 0;
  for (const StoredSample& sample : patch.samples) {
    on_the_way += std::abs(sample.position_m.x() - 0.15) > 5e-4 ? 1 : 0;
  }
  EXPECT_EQ(on_the_way, 300U);
  // Where distances are summed, all samples count alike.
  MemoryOptions all;
  all.takes_repeated = true;
  SampleMemory exact(all);
  exact.add({}, std::vector<ContactSample>(3000, at(1.0)));
  EXPECT_EQ(exact.patches().front().contacts_per_sample, 4.0);
}

TEST(SampleMemory, DetailsStayWithTheirSamples) {
  SampleMemory memory;
  const std::vector<ContactSample> samples = {at(0.0), at(0.0), at(1.0), at(2.0)};
  const std::vector<SampleDetail> details = {{}, normal_to(0.1, 0.01), {}, noise_of(2.0, 0.5, 1.0)};
  const AddResult result = memory.add({}, samples, details);
  EXPECT_EQ(result.repeated, 1U);
  EXPECT_EQ(result.detailed, 1U);
  const std::vector<ContactSample> more = {at(3.0)};
  EXPECT_EQ(memory.add({}, more).detailed, 0U);
  const StoredPatch& patch = memory.patches().front();
  ASSERT_EQ(patch.details.size(), 4U);
  EXPECT_FALSE(says_more(patch.details[1]));
  EXPECT_EQ(patch.details[2].covariance_m2, Eigen::Vector3d(2.0, 0.5, 1.0));
  EXPECT_FALSE(says_more(patch.details[3]));
  PatchContext other;
  other.patch = 1;
  memory.add(other, samples);
  EXPECT_TRUE(memory.patches().back().details.empty());
}

TEST(SampleMemory, RefusesDetailsThatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SampleDetail bare;
  bare.normal_sigma_rad = 0.1;  // of no normal
  SampleDetail without_sigma = normal_to(0.0, 0.0);
  SampleDetail short_one = normal_to(0.0, 0.1);
  short_one.normal *= 0.5;
  const std::vector<SampleDetail> bad = {bare,
                                         without_sigma,
                                         short_one,
                                         normal_to(nan, 0.1),
                                         normal_to(0.0, nan),
                                         normal_to(0.0, -0.1),
                                         noise_of(1.0, 1.0, 1.0),
                                         noise_of(-1.0, 0.0, 1.0),
                                         noise_of(1.0, nan, 1.0),
                                         noise_of(0.0, 0.0, 1.0)};
  SampleMemory memory;
  for (const SampleDetail& detail : bad) {
    const std::vector<ContactSample> sample = {at(0.0)};
    const AddResult result = memory.add({}, sample, std::vector{detail});
    EXPECT_EQ(result.rejected_detail, 1U);
    EXPECT_EQ(result.accepted, 0U);
  }
}

TEST(SampleMemory, MeansOfNeighboursHaveTheMeanOfWhatIsKnownOfThem) {
  MemoryOptions options;
  options.most_samples_per_patch = 64;
  SampleMemory memory(options);
  std::vector<ContactSample> samples;
  std::vector<SampleDetail> details;
  for (int i = 0; i < 256; ++i) {
    samples.push_back(at(i));
    SampleDetail detail = normal_to(i % 2 == 0 ? 0.1 : 0.3, 0.02);
    detail.covariance_m2 = i % 2 == 0 ? Eigen::Vector3d(3.0, 0.5, 1.0) : Eigen::Vector3d(1, 0.1, 2);
    samples.back().sigma_m = mean_sigma_m(detail.covariance_m2);
    details.push_back(detail);
  }
  memory.add({}, samples, details);
  const StoredPatch& patch = memory.patches().front();
  ASSERT_EQ(patch.details.size(), patch.samples.size());
  const ContactRun run = as_contacts(patch);
  double contacts = 0.0;
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const double weight = patch.samples[i].weight;
    contacts += weight;
    ASSERT_GE(weight, 2.0);
    const SampleDetail& mean = patch.details[i];
    // A mean of unit vectors is that of their angles but for the third power of what they are off.
    EXPECT_NEAR(std::atan2(mean.normal.y(), mean.normal.x()), 0.2, 0.1 * 0.1 * 0.1 / 6.0);
    EXPECT_NEAR(mean.normal_sigma_rad, 0.02 / std::sqrt(weight), 1e-15);
    EXPECT_LT((mean.covariance_m2 - Eigen::Vector3d(2.0, 0.3, 1.5)).norm(), 1e-12);
    EXPECT_LT((run.details[i].covariance_m2 - Eigen::Vector3d(2.0, 0.3, 1.5) / weight).norm(),
              1e-12);
    EXPECT_NEAR(run.samples[i].sigma_m, std::sqrt(1.75 / weight), 1e-12);
  }
  EXPECT_EQ(contacts, 256.0);
}

TEST(SampleMemory, ANormalOfOneOfTwoIsNoneOfTheirMean) {
  MemoryOptions options;
  options.most_samples_per_patch = 64;
  SampleMemory memory(options);
  std::vector<ContactSample> samples;
  std::vector<SampleDetail> details;
  for (int i = 0; i < 128; ++i) {
    samples.push_back(at(i));
    details.push_back(i % 2 == 0 ? normal_to(0.1, 0.02) : SampleDetail{});
  }
  memory.add({}, samples, details);
  for (const SampleDetail& detail : memory.patches().front().details) {
    EXPECT_FALSE(says_more(detail));
  }
}

TEST(SampleMemory, WhatCannotBeUsedIsRefusedAndCounted) {
  const std::vector<ContactSample> samples(3, ContactSample{Vec2(0.1, 0.2), 1e-5, 0});
  SampleMemory memory;
  for (const double radius :
       {-1e-3, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(memory.add({.tip_radius_m = radius}, samples).rejected_tip_radius, 3U) << radius;
  }
  const std::vector<SampleDetail> too_few(2);
  EXPECT_EQ(memory.add({}, samples, too_few).rejected_detail, 3U);
  EXPECT_EQ(memory.sample_count(), 0U);
}

TEST(SampleMemory, BoundsOfNothingLeaveRoomForOne) {
  MemoryOptions options;
  options.most_samples_per_patch = options.most_patches = options.most_lone_touches = 0;
  SampleMemory memory(options);
  std::size_t forgotten = 0;
  for (std::uint32_t patch = 0; patch < 20; ++patch) {
    for (std::uint32_t i = 0; i < 1 + 20 * (patch % 2); ++i) {
      const ContactSample sample{Vec2(1e-3 * i, patch), 1e-5, 0};
      forgotten += memory.add({.patch = patch}, {&sample, 1}).forgotten;
    }
  }
  // The last began as a touch, which took the place of the touch before.
  EXPECT_EQ(memory.patches().size(), 1U);
  EXPECT_EQ(memory.sample_count() + forgotten, 10U * (1 + 21));
}

TEST(SampleMemory, ASideIsStatedBySamplesThatAreTaken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SampleMemory memory;
  memory.add({}, std::vector{at(0.0), at(1.0)});
  const PatchContext left{.material_side = MaterialSide::Left};
  const PatchContext right{.material_side = MaterialSide::Right};
  EXPECT_EQ(memory.add(left, std::vector{at(nan)}).accepted, 0U);
  memory.add(right, std::vector{at(2.0)});
  ASSERT_EQ(memory.patches().size(), 1U);
  EXPECT_EQ(memory.patches().front().context.material_side, MaterialSide::Right);
  memory.add(left, std::vector{at(3.0)});
  EXPECT_EQ(memory.patches().size(), 2U);
}

}  // namespace
}  // namespace palpate
