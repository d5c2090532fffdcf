#include "core/recognition/samples/cleaned/stored_spikes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

constexpr double kNoiseOfPatch = 1e-4;

std::vector<StoredSample> arc(std::size_t n, double radius, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, kNoiseOfPatch);
  std::vector<StoredSample> samples;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2e-3 / radius * static_cast<double>(i);
    samples.push_back(
        {{radius * std::cos(angle) + noise(rng), radius * std::sin(angle) + noise(rng)},
         kNoiseOfPatch,
         1.0});
  }
  return samples;
}

TEST(Spikes, CleanArcsLoseAlmostNothing) {
  std::mt19937_64 rng = test::test_rng();
  std::size_t flagged = 0;
  constexpr int kTrials = 300;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto spikes = spikes_of(arc(120, 0.1, rng), 0.01, test::unbounded_work());
    flagged += static_cast<std::size_t>(std::count(spikes.begin(), spikes.end(), true));
  }
  // One scene in a hundred may lose a sample: the mean and five standard deviations of that law.
  const double mean = 0.01 * kTrials;
  EXPECT_LT(static_cast<double>(flagged), mean + 5.0 * std::sqrt(mean));
}

/// A patch that states noise of its samples, ten times lower on its second half.
StoredPatch half_quiet(std::mt19937_64& rng) {
  StoredPatch patch;
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < 120; ++i) {
    const double angle = 2e-2 * static_cast<double>(i);
    const double sigma_m = i < 60 ? kNoiseOfPatch : 0.1 * kNoiseOfPatch;
    const Vec2 noise(normal(rng), normal(rng));
    patch.samples.push_back(
        {0.1 * Vec2(std::cos(angle), std::sin(angle)) + sigma_m * noise, sigma_m, 1.0});
  }
  return patch;
}

/// One that states covariances, ten times longer one way, the same for all samples.
StoredPatch longer_one_way(std::mt19937_64& rng) {
  StoredPatch patch;
  std::normal_distribution<double> normal;
  const Eigen::Vector3d covariance = kNoiseOfPatch * kNoiseOfPatch * Eigen::Vector3d(1, 0, 0.01);
  for (std::size_t i = 0; i < 120; ++i) {
    const double angle = 2e-2 * static_cast<double>(i);
    const double x = normal(rng);
    patch.samples.push_back(
        {0.1 * Vec2(std::cos(angle), std::sin(angle)) + kNoiseOfPatch * Vec2(x, 0.1 * normal(rng)),
         mean_sigma_m(covariance), 1.0});
    patch.details.emplace_back().covariance_m2 = covariance;
  }
  return patch;
}

TEST(Spikes, PatchesThatStateUnevenNoiseLoseAlmostNothing) {
  std::mt19937_64 rng = test::test_rng();
  for (const auto patch_of : {half_quiet, longer_one_way}) {
    std::size_t flagged = 0;
    constexpr int kTrials = 300;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto spikes = spikes_of(patch_of(rng), 0.0, 0.01, test::unbounded_work());
      flagged += static_cast<std::size_t>(std::count(spikes.begin(), spikes.end(), true));
    }
    const double mean = 0.01 * kTrials;  // as above
    EXPECT_LT(static_cast<double>(flagged), mean + 5.0 * std::sqrt(mean));
  }
}

TEST(Spikes, NineInTenAreFoundEvenWhereAThirdOfSamplesAreSpikes) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const double fraction : {0.02, 0.1, 0.3}) {
    std::vector<StoredSample> samples = arc(200, 0.1, rng);
    std::size_t spiked = 0;
    for (StoredSample& sample : samples) {
      if (uniform(rng) < fraction) {
        ++spiked;
        const double angle = 2.0 * kPi * uniform(rng);
        sample.position_m +=
            (50.0 + 100.0 * uniform(rng)) * kNoiseOfPatch * Vec2(std::cos(angle), std::sin(angle));
      }
    }
    samples = without_spikes(samples, spikes_of(samples, 0.01, test::unbounded_work()));
    std::size_t left = 0;
    for (const StoredSample& sample : samples) {
      left += std::abs(sample.position_m.norm() - 0.1) > 8.0 * kNoiseOfPatch ? 1 : 0;
    }
    // Spikes that cluster, or stand at the very end of an arc, may hide: nine in ten are found, the
    // fit's own outlier test is for the rest.
    EXPECT_LE(left, std::max<std::size_t>(1, spiked / 10)) << fraction;
    EXPECT_GT(samples.size(), static_cast<std::size_t>(200 * (1.0 - fraction) * 0.85)) << fraction;
  }
}

TEST(Spikes, SharpBendsAndStraightEdgesAndDwellingAreNone) {
  std::mt19937_64 rng = test::test_rng();
  const auto bend = spikes_of(arc(60, 0.01, rng), 0.01,
                              test::unbounded_work());  // 12 degrees from sample to sample
  EXPECT_LE(std::count(bend.begin(), bend.end(), true), 1);
  std::vector<StoredSample> line;
  for (int i = 0; i < 50; ++i) {
    line.push_back({{1e-3 * i, 0.0}, 0.0, 1.0});
  }
  const auto straight = spikes_of(line, 0.01, test::unbounded_work());
  EXPECT_EQ(std::count(straight.begin(), straight.end(), true), 0);
  const std::vector<StoredSample> dwelling(50, StoredSample{{1.0, 2.0}, 0.0, 1.0});
  const auto dwell = spikes_of(dwelling, 0.01, test::unbounded_work());
  EXPECT_EQ(std::count(dwell.begin(), dwell.end(), true), 0);
}

}  // namespace
}  // namespace palpate
