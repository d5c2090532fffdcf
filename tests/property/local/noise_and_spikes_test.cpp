// Checks the noise estimate and the spike test against Gaussian noise on every class.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "core/local/noise.h"
#include "core/local/spikes/spikes.h"
#include "core/numerics/probability/negligible.h"
#include "core/numerics/probability/normal_law.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

const int kTrials = test::stress_count(1000);
constexpr double kSigma = 5e-5;

class OnEveryClass : public testing::TestWithParam<std::size_t> {
 protected:
  const test::TouchedArc& arc() const { return test::touched_arcs()[GetParam()]; }
};

using NoiseEstimateOf = OnEveryClass;
using SpikesOf = OnEveryClass;

const auto kArcs = testing::Range(std::size_t{0}, test::touched_arcs().size());
const auto kName = [](const auto& param_info) {
  return test::touched_arcs()[param_info.param].name;
};
INSTANTIATE_TEST_SUITE_P(AllClasses, NoiseEstimateOf, kArcs, kName);
INSTANTIATE_TEST_SUITE_P(AllClasses, SpikesOf, kArcs, kName);

TEST_P(NoiseEstimateOf, IsUnbiasedForWhiteNoise) {
  for (const int count : {30, 111, 400}) {
    const std::vector<Vec2> exact = test::samples_of(arc(), count);
    auto rng = test::test_rng(static_cast<std::uint64_t>(count));
    double sum = 0.0;
    double squares = 0.0;
    double expected_variance = 0.0;
    for (int i = 0; i < kTrials; ++i) {
      const NoiseEstimate noise = estimate_noise(test::with_noise(exact, kSigma, rng));
      ASSERT_EQ(noise.status, LocalStatus::Ok);
      const double variance = std::pow(noise.sigma_m / kSigma, 2);
      sum += variance;
      squares += variance * variance;
      expected_variance += 2.0 / noise.dof / kTrials;
    }
    if (!test::counts_tell()) continue;
    const double mean = sum / kTrials;
    const double sd = std::sqrt(squares / kTrials - mean * mean);
    // 5 standard deviations of the mean, plus 3 % because two steps depend on the data: the cut at
    // four robust standard deviations and the choice between the block lengths.
    EXPECT_NEAR(mean, 1.0, 0.03 + 5.0 * sd / std::sqrt(kTrials)) << count;
    // The dof residuals of white noise have a relative standard deviation of sqrt(2 / dof); a
    // quarter more for the same two steps.
    EXPECT_LT(sd, 1.25 * std::sqrt(expected_variance)) << count;
  }
}

TEST_P(NoiseEstimateOf, IsTheNoiseOfDenseSamplesToo) {
  // 2,000 samples 0.01 mm apart, which is a fifth of the noise.
  const std::vector<Vec2> exact = test::samples_of(arc(), 2000);
  auto rng = test::test_rng();
  const NoiseEstimate noise = estimate_noise(test::with_noise(exact, kSigma, rng));
  ASSERT_EQ(noise.status, LocalStatus::Ok);
  // 1,900 degrees of freedom: five standard deviations of sigma are 8 %.
  EXPECT_NEAR(noise.sigma_m / kSigma, 1.0, 0.08 + 0.02);
}

// Noise turns the path of nearly all blocks of 8 samples too far. The few that are fitted all the
// same have little noise by chance; taken for all, they tell a noise that is wrong by more than 2.
TEST(NoiseEstimateOfDenseSamples, IsNotThatOfTheFewBlocksThatAreFitted) {
  constexpr int kCount = 240;
  constexpr double kStep = 0.6 * kSigma;
  std::vector<Vec2> exact;
  for (int i = 0; i < kCount; ++i) {
    exact.emplace_back(kStep * i, 0.0);
  }
  auto rng = test::test_rng();
  for (int i = 0; i < 4 * kTrials; ++i) {
    const NoiseEstimate noise = estimate_noise(test::with_noise(exact, kSigma, rng));
    if (noise.status == LocalStatus::Ok) {
      // Five standard deviations of its logarithm, and 3 % as above.
      EXPECT_NEAR(std::log(noise.sigma_m / kSigma), 0.0,
                  0.03 + kNegligibleDeviations / std::sqrt(2.0 * noise.dof))
          << i;
    }
  }
}

TEST_P(NoiseEstimateOf, HardlySeesSpikes) {
  const std::vector<Vec2> exact = test::samples_of(arc(), 111);
  auto rng = test::test_rng();
  double sum = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<Vec2> samples = test::with_noise(exact, kSigma, rng);
    for (std::size_t k = 10; k < samples.size(); k += 20) {  // 6 of 111
      samples[k] += 40.0 * kSigma * left_of((exact[k + 1] - exact[k]).normalized());
    }
    sum += estimate_noise(samples).sigma_m / kSigma / kTrials;
  }
  if (!test::counts_tell()) return;
  // A spike of 40 sigma spoils its block of 16 samples. With a spike in six of seven blocks the
  // median is right within a factor of two; the root mean square would be 8.
  EXPECT_LT(sum, 2.5);
}

TEST_P(SpikesOf, FalseAlarmsComeAtTheStatedRate) {
  const std::vector<Vec2> exact = test::samples_of(arc(), 111);
  auto rng = test::test_rng();
  int patches = 0;
  for (int i = 0; i < kTrials; ++i) {
    const Spikes spikes = find_spikes(test::with_noise(exact, kSigma, rng),
                                      {.sigma_m = kSigma, .false_alarms_per_patch = 0.05});
    ASSERT_EQ(spikes.status, LocalStatus::Ok);
    patches += spikes.indices.empty() ? 0 : 1;
  }
  if (!test::counts_tell()) return;
  // 0.05 is Bonferroni's bound. Five standard deviations of a binomial variable with 1,000 trials
  // are 0.034.
  EXPECT_LT(static_cast<double>(patches) / kTrials, 0.05 + 0.034);
  EXPECT_GT(static_cast<double>(patches) / kTrials, 0.05 - 0.034);
}

TEST_P(SpikesOf, AreFoundAndTheirNeighboursSpared) {
  const std::vector<Vec2> exact = test::samples_of(arc(), 111);
  auto rng = test::test_rng();
  int found = 0;
  int others = 0;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<Vec2> samples = test::with_noise(exact, kSigma, rng);
    const std::size_t k = 6 + rng() % (samples.size() - 12);  // not at an end; see the next test
    samples[k] += 12.0 * kSigma * left_of((exact[k + 1] - exact[k]).normalized());
    for (const std::size_t index : find_spikes(samples, {.sigma_m = kSigma}).indices) {
      found += index == k ? 1 : 0;
      others += index == k ? 0 : 1;
    }
  }
  if (!test::counts_tell()) return;
  // 12 sigma, less at most a third for the leverage in the middle of a block, leave 8, against a
  // threshold of 3.9 and noise of 1: missed once in 10^4.
  EXPECT_GT(found, kTrials - 10);
  // False alarms in 1 % of the patches, and where the spike is at the end of the next block.
  EXPECT_LT(others, 0.05 * kTrials);
}

/// Noise that is ten times lower on the second half of a stroke.
std::vector<RelativeNoise> quiet_second_half(std::size_t count) {
  std::vector<RelativeNoise> noise(count);
  std::fill(noise.begin() + static_cast<std::ptrdiff_t>(count / 2), noise.end(),
            RelativeNoise{0.1, 0.1});
  return noise;
}

std::vector<Vec2> with_noise(std::span<const Vec2> exact, std::span<const RelativeNoise> noise,
                             std::mt19937_64& rng) {
  std::normal_distribution<double> normal(0.0, kSigma);
  std::vector<Vec2> samples(exact.begin(), exact.end());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = noise[i].across * normal(rng);
    samples[i] += Vec2(x, noise[i].across * normal(rng));
  }
  return samples;
}

// Counted as even, the noise of the loud half would be that of all, or its samples spikes.
TEST_P(SpikesOf, OfUnevenNoiseFalseAlarmsComeAtTheStatedRate) {
  const std::vector<Vec2> exact = test::samples_of(arc(), 111);
  const std::vector<RelativeNoise> even(exact.size());
  const std::vector<RelativeNoise> uneven = quiet_second_half(exact.size());
  auto rng = test::test_rng();
  const auto rate = [&](std::span<const RelativeNoise> noise, double sigma_m) {
    int patches = 0;
    for (int i = 0; i < kTrials; ++i) {
      const Spikes spikes =
          find_spikes(with_noise(exact, noise, rng),
                      {.sigma_m = sigma_m, .noise = noise, .false_alarms_per_patch = 0.05});
      EXPECT_EQ(spikes.status, LocalStatus::Ok);
      patches += spikes.indices.empty() ? 0 : 1;
    }
    return static_cast<double>(patches) / kTrials;
  };
  const double given = rate(uneven, kSigma);
  const double estimated = rate(uneven, 0.0);
  const double of_even = rate(even, 0.0);
  if (!test::counts_tell()) return;
  EXPECT_NEAR(given, 0.05, 0.034);  // as above
  // Noise that is estimated costs alarms of its own; as many of even noise.
  EXPECT_NEAR(estimated, of_even, std::numbers::sqrt2 * 0.034);
}

TEST_P(SpikesOf, AreFoundAmongQuietSamples) {
  const std::vector<Vec2> exact = test::samples_of(arc(), 111);
  const std::vector<RelativeNoise> noise = quiet_second_half(exact.size());
  auto rng = test::test_rng();
  int found = 0;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<Vec2> samples = with_noise(exact, noise, rng);
    const std::size_t k = samples.size() / 2 + 8 + rng() % (samples.size() / 2 - 16);
    samples[k] += 1.2 * kSigma * left_of((exact[k + 1] - exact[k]).normalized());
    for (const std::size_t index :
         find_spikes(samples, {.sigma_m = kSigma, .noise = noise}).indices) {
      found += index == k ? 1 : 0;
    }
  }
  if (!test::counts_tell()) return;
  // 12 deviations of its own noise, which are 1.2 of the loud half's: see above.
  EXPECT_GT(found, kTrials - 10);
}

TEST_P(SpikesOf, NoneOnNoiselessCurves) {
  for (const int count : {20, 50, 111, 400}) {
    const Spikes spikes = find_spikes(test::samples_of(arc(), count));
    EXPECT_TRUE(spikes.indices.empty()) << count;
  }
}

TEST(Spikes, AProbeThatDwellsOrHardlyMovesLosesNothing) {
  // Within 20 sigma noise scatters samples along the travel as well, so neither order nor gaps can
  // show a spike.
  for (const double extent : {0.0, 5.0 * kSigma}) {
    for (const std::size_t count : {40U, 111U}) {
      auto rng = test::test_rng(count);
      std::vector<Vec2> exact(count);
      for (std::size_t i = 0; i < count; ++i) {
        exact[i] = {extent * static_cast<double>(i) / static_cast<double>(count), 0.0};
      }
      for (int i = 0; i < 100; ++i) {
        const Spikes spikes = find_spikes(test::with_noise(exact, kSigma, rng));
        EXPECT_EQ(spikes.status, LocalStatus::Unresolved);
        EXPECT_TRUE(spikes.indices.empty());
      }
    }
  }
}

// A round tip that rolls about an edge goes along one side of it, round, and along the other. Of
// clean samples, three neighbours are never lost by chance (a hundredth of all strokes may lose
// one): they are the bend.
TEST(Spikes, ATightBendIsForm) {
  auto rng = test::test_rng();
  constexpr double kRadius = 1e-3;  // [m]
  for (int trial = 0; trial < kTrials / 4; ++trial) {
    const double turn = test::uniform(rng, 2.0, 3.0);  // [rad]
    const double spacing = kRadius * test::uniform(rng, 0.3, 0.5);
    const double before = spacing * test::uniform(rng, 20.0, 80.0);
    const double after = spacing * test::uniform(rng, 20.0, 80.0);
    std::vector<Vec2> way;
    for (double s = -before; s < kRadius * turn + after; s += spacing) {
      const double angle = std::clamp(s / kRadius, 0.0, turn);
      const Vec2 normal(std::sin(angle), -std::cos(angle));
      way.push_back(kRadius * normal + (s - kRadius * angle) * left_of(normal));
    }
    SpikeOptions options;
    options.sigma_m = 1e-2 * kRadius;
    const Spikes spikes = find_spikes(test::with_noise(way, options.sigma_m, rng), options);
    for (std::size_t i = 2; i < spikes.indices.size(); ++i) {
      EXPECT_GT(spikes.indices[i] - spikes.indices[i - 2], 2u)
          << "trial " << trial << ", about sample " << spikes.indices[i];
    }
  }
}

/// Work of the search for spikes in a stroke, by the samples of its fits. [rows of a sample]
double rows_of_search(const std::vector<Vec2>& samples) {
  WorkBudget work;
  find_spikes(samples, {.work = &work});
  return static_cast<double>(work.counts()[static_cast<std::size_t>(WorkKind::SpikeRow)]) /
         static_cast<double>(samples.size());
}

// Every pass finds the few that the one before has hidden. Only the first fits all blocks: 4 a
// sample, each before the noise is found, for it and after it, 12 rows at least. Any of the seven
// others takes a survey, 2 rows, and some blocks: all together hardly more than the first.
TEST(Spikes, LongTailsOfTheNoiseTakeLittleMoreThanOneSpike) {
  auto rng = test::test_rng();
  std::student_t_distribution<double> long_tails(3.0);
  const std::vector<Vec2> exact = test::samples_of(test::touched_arcs()[0], 800);
  double one_spike = 0.0;
  double many = 0.0;
  for (int i = 0; i < 20; ++i) {
    std::vector<Vec2> samples = test::with_noise(exact, kSigma, rng);
    samples[400] += 30.0 * kSigma * left_of((exact[401] - exact[400]).normalized());
    one_spike += rows_of_search(samples);
    samples = exact;
    for (Vec2& sample : samples) {
      sample += kSigma * Vec2(long_tails(rng), long_tails(rng)) / std::sqrt(3.0);
    }
    many += rows_of_search(samples);
  }
  EXPECT_LT(many, 2.5 * one_spike);
}

TEST(NormalQuantile, InvertsTheTail) {
  for (double z = 0.05; z < 30.0; z *= 1.3) {
    const double tail = std::erfc(z / std::sqrt(2.0));
    // The tail is rounded to 1.1e-16 relative. That is 1.1e-16 / z / z of z in the far tail and
    // 1.1e-16 * tail / (0.8 z) near the middle.
    EXPECT_NEAR(two_sided_normal_quantile(tail) / z, 1.0, 1e-13);
  }
}

}  // namespace
}  // namespace palpate
