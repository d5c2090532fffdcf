#include "core/recognition/samples/cleaned/passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "core/recognition/samples/cleaned/clean_patches.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

constexpr double kDeviation = 1e-5;  // of the samples

using Way = std::function<Vec2(double)>;

Vec2 circle(double u) { return 0.05 * Vec2(std::cos(3.0 * u), std::sin(3.0 * u)); }

Vec2 ellipse(double u) { return {0.04 * std::cos(2.5 * u + 0.5), 0.02 * std::sin(2.5 * u + 0.5)}; }

/// y^2 = x^3 in units of 5 cm, over its cusp.
Vec2 over_a_cusp(double u) {
  const double t = 2.0 * u - 1.0;
  return 0.05 * Vec2(t * t, t * t * t);
}

/// The end of a needle, round by two deviations of the noise.
Vec2 round_a_needle(double u) {
  const double t = kPi * (u - 0.5);
  return {0.05 * std::cos(t), 1e-3 * std::sin(t)};
}

constexpr double kUnknown = 0.0;  // noise

/// So many passes of `each` samples, there and back.
std::vector<StoredSample> strokes(const Way& way, int passes, int each, std::mt19937_64& rng,
                                  double sigma_m = kDeviation) {
  std::normal_distribution<double> normal(0.0, sigma_m);
  std::vector<StoredSample> samples;
  for (int p = 0; p < passes; ++p) {
    for (int i = 0; i < each; ++i) {
      const double u = static_cast<double>(i) / each;
      StoredSample sample;
      const double x = normal(rng);
      sample.position_m = way(p % 2 == 0 ? u : 1.0 - u) + Vec2(x, normal(rng));
      samples.push_back(sample);
    }
  }
  return samples;
}

TEST(Passes, AreCutWhereAStrokeTurnsBackOverItself) {
  std::mt19937_64 rng(3);
  for (const Way& way : {Way(circle), Way(ellipse)}) {
    for (const double sigma_m : {1e-9, 1e-6, 1e-5, 1e-4}) {
      for (const auto& [passes, each] : {std::pair(2, 16), {2, 60}, {6, 60}, {3, 300}}) {
        for (int seed = 0; seed < 20; ++seed) {
          const auto samples = strokes(way, passes, each, rng, sigma_m);
          const auto returns = reversals_of(samples, kUnknown).returns;
          ASSERT_EQ(returns.size(), static_cast<std::size_t>(passes - 1))
              << sigma_m << " " << passes << " " << each;
          for (std::size_t k = 0; k < returns.size(); ++k) {
            // The farthest on its way is one of those that noise puts there.
            const double turn = static_cast<double>(k + 1) * each;
            const double step = (way(1.0) - way(0.99)).norm() * 100.0 / each;
            EXPECT_NEAR(static_cast<double>(returns[k]), turn, 1.0 + 8.0 * sigma_m / step);
          }
        }
      }
    }
  }
}

// Shorter than the blocks by which noise is estimated, with chords that the way bends away from.
// Each pass begins at the farthest place, which is the turn.
TEST(Passes, OfFewSamplesAreCutWhereTheNoiseIsStated) {
  std::mt19937_64 rng(21);
  const auto arc = [](const Way& way) { return Way([way](double u) { return way(0.5 * u); }); };
  for (const Way& way : {arc(circle), arc(ellipse)}) {
    for (const double sigma_m : {1e-6, 1e-5, 5e-5}) {
      for (int seed = 0; seed < 20; ++seed) {
        for (const std::size_t each : {5, 10}) {
          const auto samples = strokes(way, 4, static_cast<int>(each), rng, sigma_m);
          EXPECT_EQ(reversals_of(samples, sigma_m).returns,
                    (std::vector<std::size_t>{each + 1, 2 * each + 1, 3 * each + 1}))
              << sigma_m << " " << each;
        }
      }
    }
  }
}

TEST(Passes, AStrokeThatOnlyBendsIsOne) {
  std::mt19937_64 rng(4);
  for (const Way& way : {Way(circle), Way(over_a_cusp), Way(round_a_needle)}) {
    for (const double sigma_m : {1e-9, 1e-6, 1e-5}) {
      for (const int each : {12, 60, 300, 3000}) {
        // (The arms of the needle are no farther apart than twelve samples bend from their chords.)
        for (const double stated_m : {kUnknown, each > 12 ? sigma_m : kUnknown}) {
          EXPECT_TRUE(reversals_of(strokes(way, 1, each, rng, sigma_m), stated_m).returns.empty())
              << sigma_m << " " << each << " " << stated_m;
        }
      }
    }
  }
}

TEST(Passes, ACuspIsWhereItIsAndBendsHaveNone) {
  std::mt19937_64 rng(7);
  for (const double sigma_m : {1e-9, 1e-6, 1e-5}) {
    for (const int each : {60, 300}) {
      const std::vector<StoredSample> samples = strokes(over_a_cusp, 1, each, rng, sigma_m);
      const auto cusps = reversals_of(samples, kUnknown).cusps;
      ASSERT_EQ(cusps.size(), 1U) << sigma_m << " " << each;
      // Near the cusp x = 5 cm t^2: within a few deviations of the noise the farthest may be any.
      const double reach = std::sqrt(4.0 * sigma_m / 0.05) / 2.0 * each;
      EXPECT_NEAR(static_cast<double>(cusps.front()), 0.5 * each, 2.0 + reach);
      EXPECT_TRUE(reversals_of(strokes(ellipse, 1, each, rng, sigma_m), kUnknown).cusps.empty());
      // A spike turns a stroke back twice, and forward again.
      std::vector<StoredSample> spiked = strokes(ellipse, 1, each, rng, sigma_m);
      spiked[static_cast<std::size_t>(each) / 2].position_m -= Vec2(0.0, 0.03);
      EXPECT_TRUE(reversals_of(spiked, kUnknown).cusps.empty());
    }
  }
}

/// Runs of one to three spikes, one in every twelve samples. They reach 20 mm or less.
std::vector<StoredSample> with_runs_of_spikes(std::vector<StoredSample> samples,
                                              std::mt19937_64& rng) {
  std::uniform_real_distribution<double> reach(-0.02, 0.02);
  for (std::size_t i = 6; i + 9 < samples.size(); i += 12) {
    for (std::size_t k = i; k < i + 1 + i / 12 % 3; ++k) {
      const double x = reach(rng);
      samples[k].position_m += Vec2(x, reach(rng));
    }
  }
  return samples;
}

// Also where the steps are no longer than the noise, so that what turns back does so within it.
TEST(Passes, RunsOfSpikesTurnNothingBackAndHideNoTurn) {
  std::mt19937_64 rng(9);
  for (const double sigma_m : {1e-9, 1e-6, 1e-5, 1e-4}) {
    for (int seed = 0; seed < 25; ++seed) {
      const auto spiked = [&](const Way& way, int passes) {
        return reversals_of(with_runs_of_spikes(strokes(way, passes, 300, rng, sigma_m), rng),
                            sigma_m);
      };
      EXPECT_EQ(spiked(ellipse, 1), Reversals{}) << sigma_m;
      EXPECT_EQ(spiked(circle, 1), Reversals{}) << sigma_m;
      EXPECT_EQ(spiked(ellipse, 3).returns.size(), 2U) << sigma_m;
      EXPECT_EQ(spiked(over_a_cusp, 1).cusps.size(), 1U) << sigma_m;
    }
  }
}

TEST(Passes, AStrokeShorterThanItsNoiseIsOne) {
  std::mt19937_64 rng(5);
  const Way short_way = [](double u) { return Vec2(10.0 * kDeviation * u, 0.0); };
  for (int seed = 0; seed < 50; ++seed) {
    EXPECT_TRUE(reversals_of(strokes(short_way, 1, 500, rng), kUnknown).returns.empty()) << seed;
  }
}

// Noise of a thirtieth of the way, by samples a twentieth of it apart: only the whole stroke is
// much longer than it, and that doubles back.
TEST(Passes, AreCutByTheStatedNoiseWhereTheSamplesDoNotShowIt) {
  std::mt19937_64 rng(8);
  constexpr double kNoise = 3e-4;  // [m]
  const Way bend = [](double u) { return Vec2(0.01 * std::sin(u), 0.01 * (1.0 - std::cos(u))); };
  constexpr int kEach = 200;
  for (int seed = 0; seed < 50; ++seed) {
    const auto samples = strokes(bend, 2, kEach, rng, kNoise);
    const auto returns = reversals_of(samples, kNoise).returns;
    ASSERT_EQ(returns.size(), 1U) << seed;
    EXPECT_NEAR(static_cast<double>(returns.front()), kEach, 1.0 + 8.0 * kNoise / 0.01 * kEach);
    EXPECT_TRUE(reversals_of(strokes(bend, 1, kEach, rng, kNoise), kNoise).returns.empty()) << seed;
  }
}

TEST(Passes, HaveAllSamplesInTheDirectionOfTheFirst) {
  std::mt19937_64 rng(6);
  StoredPatch patch;
  patch.samples = strokes(ellipse, 3, 40, rng);
  patch.details.resize(patch.samples.size());
  for (std::size_t i = 0; i < patch.details.size(); ++i) {
    patch.details[i].normal_sigma_rad = static_cast<double>(i);
  }
  const std::vector<StoredPatch> passes =
      passes_of(patch, reversals_of(patch.samples, kUnknown).returns);
  ASSERT_EQ(passes.size(), 3U);
  std::size_t before = 0;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    const std::size_t n = passes[p].samples.size();
    ASSERT_EQ(n, passes[p].details.size());
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t of = before + (p % 2 == 0 ? i : n - 1 - i);
      EXPECT_EQ(passes[p].samples[i].position_m, patch.samples[of].position_m);
      EXPECT_EQ(passes[p].details[i].normal_sigma_rad, static_cast<double>(of));
    }
    before += n;
  }
  EXPECT_EQ(before, patch.samples.size());
}

// Where few samples lie between two turns and spikes among them, both turns were once taken to the
// same sample, with a pass of nothing between them.
TEST(Passes, HaveSamplesOfTheirOwnAmongSpikes) {
  constexpr double kSigma = 4e-6;  // [m]
  std::mt19937_64 rng(7);
  std::uniform_int_distribution<int> some(1, 10);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, kSigma);
  std::size_t cut = 0;
  for (int scene = 0; scene < 6'000; ++scene) {
    StoredPatch patch;
    const double spikes = 0.3 * share(rng);
    double from = 0.0;
    for (int passes = some(rng); passes >= 0; --passes) {
      const double to = share(rng);
      const int each = some(rng);
      for (int i = 0; i < each; ++i) {
        StoredSample& sample = patch.samples.emplace_back();
        const double x = noise(rng);
        sample.position_m =
            0.5 * circle(0.1 * (from + (to - from) * i / each)) + Vec2(x, noise(rng));
        if (share(rng) < spikes) sample.position_m += 0.02 * Vec2(share(rng), share(rng));
        sample.sigma_m = kSigma;
      }
      from = to;
    }
    patch.newest_m = patch.samples.back().position_m;
    CleanPatches clean;
    clean.update({&patch, 1}, {.false_alarm = 1e-3}, test::unbounded_work());
    for (const StoredPatch& pass : clean.moved()) ASSERT_FALSE(pass.samples.empty()) << scene;
    EXPECT_EQ(clean.moved_count() + clean.dwelling_count(), patch.samples.size()) << scene;
    cut += clean.moved().size() > 1 ? 1 : 0;
  }
  EXPECT_GT(cut, 0U);
}

}  // namespace
}  // namespace palpate
