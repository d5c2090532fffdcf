#include "core/recognition/samples/dwells.h"
#include "core/recognition/samples/dwell_means.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include "core/recognition/samples/dwell_spikes.h"

namespace palpate {
namespace {

constexpr double kNoise = 1e-5;
constexpr double kPart = 0.05;  // radius of the circle
constexpr std::size_t kMoving = 300;

/// A stroke along two radians of a circle, in which the probe stands still for so many samples.
/// `fresh`: the share of the noise, as a deviation, that each sample of a dwell has of its own.
struct DwellingStroke {
  std::vector<StoredSample> samples;
  std::size_t begin = 0;  ///< of the dwell
};

Vec2 on_circle(double angle) { return kPart * Vec2(std::cos(angle), std::sin(angle)); }

class Dwells : public ::testing::Test {
 protected:
  Vec2 noise(double sigma = kNoise) {
    std::normal_distribution<double> normal(0.0, sigma);
    const double x = normal(rng_);
    return {x, normal(rng_)};
  }

  StoredSample sample_at(const Vec2& place) {
    StoredSample sample;
    sample.position_m = place;
    sample.sigma_m = kNoise;
    return sample;
  }

  DwellingStroke stroke(std::size_t standing, double fresh, std::size_t at = 137) {
    DwellingStroke result;
    for (std::size_t i = 0; i < kMoving; ++i) {
      const Vec2 place = on_circle(2.0 * static_cast<double>(i) / kMoving);
      result.samples.push_back(sample_at(place + noise()));
      if (i == at) {
        result.begin = i;
        const Vec2 shared = place + std::sqrt(1.0 - fresh * fresh) * noise();
        result.samples.back().position_m = shared + noise(fresh * kNoise);
        for (std::size_t k = 1; k < standing; ++k) {
          result.samples.push_back(sample_at(shared + noise(fresh * kNoise)));
        }
      }
    }
    return result;
  }

  std::mt19937_64 rng_{7};
};

TEST_F(Dwells, AStrokeAtEvenSpeedHasNone) {
  for (int seed = 0; seed < 200; ++seed) {
    EXPECT_TRUE(dwells_of(stroke(1, 1.0).samples).empty()) << seed;
  }
}

TEST_F(Dwells, AStrokeThatSlowsDownHasNone) {
  // A tenth of the way at a twentieth of the speed: 1/30 of a step is a hundred times the noise.
  std::vector<StoredSample> samples;
  for (double u = 0.0; u < 1.0; u += (u > 0.4 && u < 0.5 ? 0.05 : 1.0) / 200.0) {
    samples.push_back(sample_at(on_circle(2.0 * u) + 0.01 * noise()));
  }
  EXPECT_TRUE(dwells_of(samples).empty());
}

TEST_F(Dwells, AWayOverACuspHasNone) {
  // Even steps of t in (t^2, t^3): next to the cusp it moves slowly, goes there and back along
  // almost the same way, and is not still.
  for (const int count : {200, 529, 2000}) {
    std::vector<StoredSample> samples;
    for (int i = 0; i < count; ++i) {
      const double t = -1.0 + 2.0 * i / (count - 1);
      samples.push_back(sample_at(kPart * Vec2(t * t, 1.8 * t * t * t - 0.58 * t * t) + noise()));
    }
    for (const PatchSpan& dwell : dwells_of(samples)) {
      Vec2 low = samples[dwell.begin].position_m;
      Vec2 high = low;
      for (std::size_t i = dwell.begin; i < dwell.end; ++i) {
        low = low.cwiseMin(samples[i].position_m);
        high = high.cwiseMax(samples[i].position_m);
      }
      // The farthest of so many samples of one place are some seven deviations apart.
      EXPECT_LT((high - low).maxCoeff(), 10.0 * kNoise) << count;
    }
  }
}

TEST_F(Dwells, AreFoundToASampleOrTwoWhateverTheirNoise) {
  for (const double fresh : {1.0, 0.1, 1e-3, 1e-9}) {
    for (const std::size_t standing : {40U, 200U, 2000U}) {
      const DwellingStroke found = stroke(standing, fresh);
      const auto dwells = dwells_of(found.samples);
      ASSERT_EQ(dwells.size(), 1U) << fresh << " " << standing;
      // Within three deviations of the mean there are seven samples in eight at least (Chebyshev);
      // beside it a step is 33 deviations of the noise.
      EXPECT_GE(dwells[0].begin, found.begin) << fresh;
      EXPECT_LE(dwells[0].end, found.begin + standing) << fresh;
      EXPECT_GE(8 * dwells[0].size(), 7 * standing - 8 * 2) << fresh << " " << standing;
    }
  }
}

TEST_F(Dwells, OfSamplesThatJitterTogetherAreFoundToo) {
  DwellingStroke found = stroke(400, 1e-3);
  constexpr double kShared = 0.9;  // of the error before
  Vec2 error = noise();
  for (std::size_t i = found.begin; i < found.begin + 400; ++i) {
    error = kShared * error + std::sqrt(1.0 - kShared * kShared) * noise();
    found.samples[i].position_m += error;
  }
  const auto dwells = dwells_of(found.samples);
  ASSERT_GE(dwells.size(), 1U);
  const std::size_t of_dwells =
      std::accumulate(dwells.begin(), dwells.end(), std::size_t{0},
                      [](std::size_t sum, const PatchSpan& span) { return sum + span.size(); });
  EXPECT_GE(of_dwells, 300U);
}

TEST_F(Dwells, WeighWhatTheirNoiseLetsThem) {
  // Fresh noise averages out, shared noise does not, and what nobody states weighs as one.
  constexpr std::size_t kStanding = 400;
  const auto weight_of = [&](double fresh, bool stated) {
    StoredPatch patch;
    patch.samples = stroke(kStanding, fresh).samples;
    for (StoredSample& sample : patch.samples) {
      sample.sigma_m = stated ? kNoise : 0.0;
    }
    const auto dwells = dwells_of(patch.samples);
    EXPECT_EQ(dwells.size(), 1U);
    const StoredPatch means = with_means(patch, dwells, 0.0);
    EXPECT_EQ(means.samples.size(), patch.samples.size() - dwells[0].size() + 1);
    return means.samples[dwells[0].begin].weight;
  };
  // The steps of 400 samples tell how fresh they are to 1 in 20.
  EXPECT_GE(weight_of(1.0, true), 0.7 * kStanding);
  EXPECT_LE(weight_of(1.0, true), kStanding);
  // Half of the variance is shared: two samples' worth, and the scatter is known to 3 in 20.
  const double half = weight_of(std::sqrt(0.5), true);
  EXPECT_GE(half, 1.7);
  EXPECT_LE(half, 2.5);
  EXPECT_NEAR(weight_of(1e-3, true), 1.0, 1e-5);
  EXPECT_EQ(weight_of(1.0, false), 1.0);
}

TEST_F(Dwells, OfATouchThatIsHeldAreTheWholePatch) {
  for (int seed = 0; seed < 50; ++seed) {
    std::vector<StoredSample> held;
    for (int i = 0; i < 40; ++i) {
      held.push_back(sample_at(on_circle(1.0) + noise()));
    }
    EXPECT_TRUE(is_one_place(held, 0.0, kPart));
    for (StoredSample& sample : held) {
      sample.sigma_m = 0.0;
    }
    EXPECT_TRUE(is_one_place(held, 0.0, kPart));          // a thousandth of the part
    EXPECT_FALSE(is_one_place(held, 0.0, 2.0 * kNoise));  // it is the part
  }
}

// Read two to four times: no order can be seen, but noise that is stated explains all of it, and
// over a thousandth of the part no curve is told.
TEST_F(Dwells, OfAFewReadingsAreOnePlace) {
  constexpr int kPlaces = 1000;
  for (const std::size_t count : {2, 3, 4}) {
    int apart = 0;
    for (int place = 0; place < kPlaces; ++place) {
      std::vector<StoredSample> held;
      for (std::size_t i = 0; i < count; ++i) {
        held.push_back(sample_at(on_circle(1.0) + noise()));
      }
      apart += is_one_place(held, 0.0, kPart) ? 0 : 1;
      for (StoredSample& sample : held) {
        sample.sigma_m = 0.0;
      }
      EXPECT_TRUE(is_one_place(held, 0.0, kPart)) << count;
      EXPECT_FALSE(is_one_place(held, 0.0, 10.0 * kNoise)) << count;  // a tenth of the part or so
    }
    // A spread of 1.6 times the noise's: chi-square of 2 (n - 1) degrees above 5.12 n, which two
    // readings exceed once in 167 times and more of them more seldom. Four deviations.
    EXPECT_LE(apart, 6.0 + 4.0 * std::sqrt(6.0)) << count;
  }
}

TEST_F(Dwells, AShortStrokeIsNoHeldTouch) {
  // 50 deviations long, a hundredth of the part.
  for (int seed = 0; seed < 50; ++seed) {
    std::vector<StoredSample> samples;
    for (int i = 0; i < 40; ++i) {
      samples.push_back(sample_at(on_circle(1.0 + 50.0 * kNoise / kPart * i / 40.0) + noise()));
    }
    EXPECT_FALSE(is_one_place(samples, 0.0, kPart)) << seed;
  }
}

TEST_F(Dwells, AFewSamplesInARowAreNoHeldTouch) {
  // A hundredth of the part from first to last, in even steps, with noise that is small beside
  // these: however few, their steps have an order.
  for (std::size_t count = 2; count <= 8; ++count) {
    for (int seed = 0; seed < 50; ++seed) {
      std::vector<StoredSample> samples;
      for (std::size_t i = 0; i < count; ++i) {
        const double along = static_cast<double>(i) / static_cast<double>(count - 1);
        samples.push_back(sample_at(on_circle(1.0 + 1e-2 * along) + 0.1 * noise()));
      }
      EXPECT_FALSE(is_one_place(samples, 0.0, kPart)) << count << " samples, " << seed;
    }
  }
}

TEST_F(Dwells, APatchInNoOrderIsNoHeldTouch) {
  // Touches of a part one by one, in one patch and in no order.
  std::uniform_real_distribution<double> angle(0.0, 2.0 * kPi);
  std::vector<StoredSample> samples;
  for (int i = 0; i < 60; ++i) {
    samples.push_back(sample_at(on_circle(angle(rng_)) + noise()));
  }
  EXPECT_FALSE(is_one_place(samples, 0.0, kPart));
  EXPECT_TRUE(dwells_of(samples).empty());
}

TEST_F(Dwells, ThatOverlapLeaveEachOtherSamplesToMerge) {
  // A dwell beside one that scatters wider: the wide one reaches over all of the other but its last
  // sample, after which the probe shakes itself loose.
  constexpr double kStep = 100.0 * kNoise;
  std::uniform_real_distribution<double> uniform;
  std::size_t beside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<StoredSample> samples;
    Vec2 place = Vec2::Zero();
    const auto travel = [&] {
      for (int i = 0; i < 32; ++i) {
        samples.push_back(sample_at(place));
        place.x() += kStep;
      }
    };
    travel();
    const double wide = (0.005 + 0.145 * uniform(rng_)) * kStep;
    for (int i = 0; i < 16; ++i) samples.push_back(sample_at(place + noise(wide)));
    const Vec2 other = place + (0.5 + 2.5 * uniform(rng_)) * wide * Vec2::UnitY();
    const double narrow = wide * std::exp(-9.0 + 8.0 * uniform(rng_));
    for (int i = 0; i < 9; ++i) samples.push_back(sample_at(other + noise(narrow)));
    const double growth = 1.0 + 2.0 * uniform(rng_);
    double shake = wide * std::exp(-5.0 + 6.0 * uniform(rng_)) / std::pow(growth, 3.0);
    for (int i = 0; i < 7; ++i) {
      samples.push_back(sample_at(other + shake * Vec2::UnitX()));
      shake *= -growth;
    }
    travel();
    const std::vector<PatchSpan> dwells = dwells_of(samples);
    for (std::size_t i = 0; i < dwells.size(); ++i) {
      ASSERT_GE(dwells[i].end, dwells[i].begin + 2) << trial;
      ASSERT_TRUE(i == 0 || dwells[i].begin >= dwells[i - 1].end) << trial;
      beside += i > 0 && dwells[i].begin == dwells[i - 1].end ? 1 : 0;
    }
    StoredPatch patch;
    patch.samples = samples;
    for (const StoredSample& sample : with_means(patch, dwells, 0.0).samples) {
      ASSERT_TRUE(std::isfinite(sample.weight)) << trial;
    }
  }
  EXPECT_GT(beside, 0U);
}

/// Where most samples of a stroke are of a place at which it stands still from early on, its speed
/// is that of their scatter, and none of them was slower.
TEST_F(Dwells, AHoldAfterAFewPlacesIsOnePlace) {
  for (const std::size_t places : {1, 2, 5}) {
    for (const double step : {20.0, 400.0, 2000.0}) {  // noises
      SCOPED_TRACE(::testing::Message() << places << " places " << step << " noises apart");
      StoredPatch patch;
      for (std::size_t i = 0; i < places + 100; ++i) {
        const double way = step * kNoise * static_cast<double>(std::min(i, places));
        patch.samples.push_back(sample_at(on_circle(way / kPart) + noise()));
      }
      const StoredPatch merged = without_dwells(patch, kNoise);
      ASSERT_EQ(merged.samples.size(), places + 1);
      EXPECT_LT((merged.samples.back().position_m -
                 on_circle(step * kNoise * static_cast<double>(places) / kPart))
                    .norm(),
                kNoise);
    }
  }
}

/// Readings 5 to 24 of 30 are of one place; those of these in `spikes` are not.
StoredPatch held_in_the_middle(const std::vector<std::size_t>& spikes) {
  StoredPatch patch;
  std::mt19937_64 rng(11);
  std::normal_distribution<double> normal(0.0, kNoise);
  for (std::size_t i = 0; i < 30; ++i) {
    const double x = i < 5 ? -1e-3 * static_cast<double>(5 - i)
                           : 1e-3 * static_cast<double>(std::max<std::size_t>(i, 24) - 24);
    const double y = normal(rng);
    patch.samples.push_back({Vec2(x + normal(rng), y), kNoise});
    patch.details.emplace_back().normal_sigma_rad = static_cast<double>(i);
  }
  for (const std::size_t i : spikes) patch.samples[i].position_m.y() += 30.0 * kNoise;
  return patch;
}

TEST_F(Dwells, LeaveTheirSpikesBesideThem) {
  for (const double stated : {kNoise, 0.0}) {
    StoredPatch patch = held_in_the_middle({7, 8, 20});
    for (StoredSample& sample : patch.samples) sample.sigma_m = stated;
    const StoredPatch before = patch;
    std::vector<PatchSpan> dwells = {{5, 25}};
    set_spikes_apart(0.0, 0.01, &patch, &dwells);
    EXPECT_EQ(dwells.front().begin, 5U);
    ASSERT_EQ(dwells.front().end, 22U);
    std::vector<bool> seen(30, false);
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
      const auto of = static_cast<std::size_t>(patch.details[i].normal_sigma_rad);
      seen[of] = true;
      EXPECT_EQ(patch.samples[i].position_m, before.samples[of].position_m);
      EXPECT_EQ(patch.samples[i].is_off_dwell, of == 7 || of == 8 || of == 20);
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 30);
  }
}

TEST_F(Dwells, ThatEndAStrokeHaveTheirSpikesBefore) {
  StoredPatch patch = held_in_the_middle({8});
  patch.samples.resize(25);
  patch.details.resize(25);
  std::vector<PatchSpan> dwells = {{5, 25}};
  set_spikes_apart(0.0, 0.01, &patch, &dwells);
  EXPECT_EQ(dwells.front().begin, 6U);
  EXPECT_TRUE(patch.samples[5].is_off_dwell);
}

TEST_F(Dwells, HaveNoSpikesWhereMostReadingsAreOneNumber) {
  StoredPatch patch = held_in_the_middle({});
  for (std::size_t i = 5; i < 25; ++i) {
    patch.samples[i] = {Vec2(i % 3 == 0 ? kNoise : 0.0, 0.0)};
  }
  std::vector<PatchSpan> dwells = {{5, 25}};
  set_spikes_apart(0.0, 0.01, &patch, &dwells);
  EXPECT_EQ(dwells.front().end, 25U);
  // What is stated is no spike, though the readings scatter by less.
  for (StoredSample& sample : patch.samples) sample.sigma_m = kNoise;
  set_spikes_apart(0.0, 0.01, &patch, &dwells);
  EXPECT_EQ(dwells.front().end, 25U);
}

}  // namespace
}  // namespace palpate
