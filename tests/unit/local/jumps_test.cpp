#include "core/local/spikes/jumps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate {
namespace {

std::vector<std::size_t> flagged(const std::vector<Vec2>& samples) {
  const std::vector<std::uint8_t> flags = detours_of(samples);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] != 0) indices.push_back(i);
  }
  return indices;
}

std::vector<Vec2> straight(int count) {
  std::vector<Vec2> samples;
  for (int i = 0; i < count; ++i) samples.emplace_back(1e-3 * i, 0.0);
  return samples;
}

TEST(Detours, AreRunsThatLeaveThePathAndComeBack) {
  std::vector<Vec2> samples = straight(40);
  samples[7].y() += 0.01;
  for (const std::size_t i : {15U, 16U}) samples[i].y() -= 0.02;  // beside each other
  for (const std::size_t i : {25U, 27U}) samples[i].x() -= 0.03;  // with a good one between
  for (std::size_t i = 33; i < 37; ++i) samples[i].y() += 0.02;   // a step of four is form
  EXPECT_EQ(flagged(samples), (std::vector<std::size_t>{7, 15, 16, 25, 26, 27}));
}

TEST(Detours, GapsUnevenSpeedTurnsAndNoiseAreNone) {
  std::mt19937_64 rng(1);
  std::exponential_distribution<double> gap(1.0);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Vec2> uneven, there_and_back;
  double on = 0.0;
  for (int i = 0; i < 2000; ++i) {
    on += gap(rng);
    uneven.emplace_back(on, 0.0);
  }
  for (int i = -50; i <= 50; ++i) there_and_back.emplace_back(50.0 - std::abs(i), 0.0);
  EXPECT_TRUE(flagged(uneven).empty());
  EXPECT_TRUE(flagged(there_and_back).empty());
  // Samples of one place: a step there is longer than four of the short ones, which are 0.67 sigma
  // sqrt(2) (the fifth part of Rayleigh's law), in exp(-(4 * 0.67)^2 / 2) = 2.8 % of all.
  std::vector<Vec2> dwelling;
  for (int i = 0; i < 2000; ++i) {
    const double x = noise(rng);
    dwelling.emplace_back(x, noise(rng));
  }
  EXPECT_LT(flagged(dwelling).size(), 2000 * 28 / 1000 * kLongestRunOfSpikes);
}

TEST(Detours, OfFewerSamplesThanARunAreNone) {
  for (int count = 0; count < 4; ++count) EXPECT_TRUE(flagged(straight(count)).empty());
}

}  // namespace
}  // namespace palpate
