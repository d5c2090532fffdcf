// Which ends of strokes are told as an approach: those that are one, and none of a clean stroke.
#include "node/check/straight_ends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "tests/support/stroke.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::log_uniform;
using test::uniform;

// Of the shapes of random_stroke.
constexpr std::size_t kCircle = 1;
constexpr std::size_t kSemiCubical = 6;

void add_noise(double sigma_m, std::mt19937_64& rng, std::vector<Vec2>* samples) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  for (Vec2& p : *samples) p += Vec2(noise(rng), noise(rng));
}

bool has_straight_end(const std::vector<Vec2>& samples) {
  const StraightEnds ends = straight_ends(samples);
  return ends.first.samples + ends.last.samples > 0;
}

/// A stroke of 1 to 4 cm, and the distance between its samples.
struct Clean {
  std::vector<Vec2> samples;
  double step_m = 0.0;
};

Clean clean_stroke(std::size_t shape, std::mt19937_64& rng) {
  const test::TrueStroke stroke = test::random_stroke(shape, log_uniform(rng, 0.01, 0.04), rng);
  const auto stride = static_cast<std::size_t>(uniform(rng, 1.0, 6.0));
  return {stroke.samples(stride), static_cast<double>(stride) * stroke.step_m};
}

/// So far from the part, along its normal or 10 degrees beside it; `along` is the travel there.
Vec2 off_the_part(const Vec2& along, double distance_m, std::mt19937_64& rng) {
  const double angle = test::random_sign(rng) * (0.5 * kPi + uniform(rng, -0.17, 0.17));
  const Vec2 x = along.normalized() * distance_m;
  return std::cos(angle) * x + std::sin(angle) * Vec2(-x.y(), x.x());
}

/// With so many samples in the air before and behind, each at a pace of its own.
std::vector<Vec2> with_approach(const Clean& part, std::size_t before, std::size_t behind,
                                std::mt19937_64& rng) {
  constexpr double kPace = 3.0;  // times faster or slower than the stroke
  const std::vector<Vec2>& on = part.samples;
  const Vec2 in =
      off_the_part(on[1] - on[0], part.step_m * log_uniform(rng, 1 / kPace, kPace), rng);
  const Vec2 out = off_the_part(on.back() - on[on.size() - 2],
                                part.step_m * log_uniform(rng, 1 / kPace, kPace), rng);
  std::vector<Vec2> samples;
  for (std::size_t i = before; i > 0; --i)
    samples.push_back(on.front() + static_cast<double>(i) * in);
  samples.insert(samples.end(), on.begin(), on.end());
  for (std::size_t i = 1; i <= behind; ++i) {
    samples.push_back(on.back() + static_cast<double>(i) * out);
  }
  return samples;
}

/// A rectangle with round corners from a place on its lower edge on, counterclockwise.
std::vector<Vec2> rounded_rectangle(double radius_m, double edge_m, double step_m,
                                    std::size_t count) {
  constexpr double kLong = 0.05;   // between the corners' arcs [m]
  constexpr double kShort = 0.03;  // [m]
  std::vector<Vec2> samples;
  Vec2 place(0.0, 0.0);
  double angle = 0.0;
  double left_m = edge_m;  // of the edge; below 0: within the corner
  for (std::size_t corner = 1; samples.size() < count;) {
    samples.push_back(place);
    left_m -= step_m;
    const bool is_edge = left_m > 0.0;
    if (!is_edge)
      angle = std::min(angle + step_m / radius_m, 0.5 * kPi * static_cast<double>(corner));
    place += step_m * Vec2(std::cos(angle), std::sin(angle));
    if (!is_edge && angle >= 0.5 * kPi * static_cast<double>(corner)) {
      left_m = corner++ % 2 == 1 ? kShort : kLong;
    }
  }
  return samples;
}

TEST(StraightEnds, AnApproachAndARetractAreFoundOnEveryCurve) {
  std::mt19937_64 rng = test::test_rng();
  for (std::size_t shape = 0; shape < test::kStrokeShapes; ++shape) {
    // Over a cusp the stroke itself turns as sharply as at a corner.
    if (shape == kSemiCubical) continue;
    for (int i = 0; i < test::stress_count(100); ++i) {
      const Clean part = clean_stroke(shape, rng);
      const auto before = static_cast<std::size_t>(uniform(rng, 6.0, 21.0));
      const auto behind = static_cast<std::size_t>(uniform(rng, 6.0, 21.0));
      std::vector<Vec2> samples = with_approach(part, before, behind, rng);
      add_noise(part.step_m * log_uniform(rng, 1e-3, 0.03), rng, &samples);
      const StraightEnds ends = straight_ends(samples);
      // The sample at the corner is on the line too. Noise may hide another, or take one for off
      // it.
      EXPECT_NEAR(static_cast<double>(ends.first.samples), static_cast<double>(before) + 0.5, 1.5)
          << shape;
      EXPECT_NEAR(static_cast<double>(ends.last.samples), static_cast<double>(behind) + 0.5, 1.5)
          << shape;
      EXPECT_NEAR(ends.first.corner_rad, 0.5 * kPi, 0.5);
      // Without them, nothing more is said.
      const std::vector<Vec2> rest(
          samples.begin() + static_cast<std::ptrdiff_t>(ends.first.samples),
          samples.end() - static_cast<std::ptrdiff_t>(ends.last.samples));
      EXPECT_FALSE(has_straight_end(rest)) << shape;
    }
  }
}

TEST(StraightEnds, CleanStrokesHaveNone) {
  std::mt19937_64 rng = test::test_rng();
  for (std::size_t shape = 0; shape < test::kStrokeShapes; ++shape) {
    for (int i = 0; i < test::stress_count(300); ++i) {
      Clean stroke = clean_stroke(shape, rng);
      add_noise(stroke.step_m * log_uniform(rng, 1e-4, 2.0), rng, &stroke.samples);
      EXPECT_FALSE(has_straight_end(stroke.samples)) << shape;
    }
  }
}

TEST(StraightEnds, DwellsAndSpikesAreNone) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(500); ++i) {
    const Clean stroke = clean_stroke(static_cast<std::size_t>(i) % test::kStrokeShapes, rng);
    const double sigma_m = stroke.step_m * log_uniform(rng, 1e-3, 0.3);
    std::vector<Vec2> dwelling = stroke.samples;
    for (const double place : {0.0, uniform(rng, 0.0, 1.0), 1.0}) {
      const auto at = static_cast<std::ptrdiff_t>(place * static_cast<double>(dwelling.size() - 1));
      const Vec2 held = dwelling[static_cast<std::size_t>(at)];
      dwelling.insert(dwelling.begin() + at, static_cast<std::size_t>(uniform(rng, 5.0, 60.0)),
                      held);
    }
    add_noise(sigma_m, rng, &dwelling);
    EXPECT_FALSE(has_straight_end(dwelling));
    std::vector<Vec2> spiky = stroke.samples;
    add_noise(sigma_m, rng, &spiky);
    std::normal_distribution<double> spike(0.0, 10.0 * stroke.step_m);
    for (Vec2& p : spiky) {
      if (uniform(rng, 0.0, 1.0) < 0.05) p += Vec2(spike(rng), spike(rng));
    }
    EXPECT_FALSE(has_straight_end(spiky));
  }
}

TEST(StraightEnds, AnApproachIsFoundBesideSpikesAndADwellAtTheCorner) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(200); ++i) {
    Clean part = clean_stroke(kCircle, rng);
    const std::size_t middle = part.samples.size() / 2;
    part.samples[middle] +=
        off_the_part(part.samples[middle + 1] - part.samples[middle], 10.0 * part.step_m, rng);
    std::vector<Vec2> samples = with_approach(part, 12, 12, rng);
    samples.insert(samples.begin() + 12, 5, part.samples.front());
    add_noise(0.03 * part.step_m, rng, &samples);
    const StraightEnds ends = straight_ends(samples);
    EXPECT_GE(ends.first.samples, 12U);
    EXPECT_LE(ends.first.samples, 19U);
    EXPECT_GE(ends.last.samples, 12U);
  }
}

TEST(StraightEnds, AnEdgeWithARoundCornerIsNone) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(500); ++i) {
    constexpr std::size_t kSamples = 240;
    const double step_m = 2e-4;
    // Edges of any length before a corner of several samples; of a quarter and more before any.
    const bool is_sharp = i % 2 == 0;
    const double radius_m =
        step_m * (is_sharp ? log_uniform(rng, 0.5, 10.0) : log_uniform(rng, 10.0, 40.0));
    const double edge = is_sharp ? uniform(rng, 0.26, 0.3) : uniform(rng, 0.03, 0.3);
    std::vector<Vec2> samples = rounded_rectangle(radius_m, edge * kSamples * step_m, step_m,
                                                  is_sharp ? kSamples / 2 : kSamples);
    add_noise(step_m * log_uniform(rng, 1e-3, 0.3), rng, &samples);
    EXPECT_FALSE(has_straight_end(samples)) << i;
  }
}

TEST(StraightEnds, TheShortArmOfACuspIsNone) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(500); ++i) {
    // y^2 = c^2 x^3 in steps of arc length, from a place before the cusp on.
    const double c = log_uniform(rng, 2.0, 10.0);  // [m^(-1/2)]
    const double step_m = log_uniform(rng, 1e-4, 5e-4);
    std::vector<Vec2> samples;
    double t = -std::sqrt(uniform(rng, 4.0, 40.0) * step_m);
    double way_m = 0.0;
    while (samples.size() < 160) {
      constexpr double kFine = 2e-5;
      way_m += kFine * std::hypot(2.0 * t, 3.0 * c * t * t);
      t += kFine;
      if (way_m >= step_m) {
        way_m -= step_m;
        samples.emplace_back(t * t, c * t * t * t);
      }
    }
    add_noise(step_m * log_uniform(rng, 1e-3, 0.1), rng, &samples);
    EXPECT_FALSE(has_straight_end(samples)) << i << " c " << c;
  }
}

TEST(StraightEnds, FewSamplesAndOnePlaceHaveNone) {
  for (const std::size_t count : {0U, 1U, 7U, 23U, 24U, 1000U}) {
    EXPECT_FALSE(has_straight_end(std::vector<Vec2>(count, Vec2(1.0, 2.0))));
    std::vector<Vec2> line;
    for (std::size_t i = 0; i < count; ++i) line.emplace_back(1e-4 * static_cast<double>(i), 0.0);
    EXPECT_FALSE(has_straight_end(line));
  }
}

TEST(StraightEnds, ALongStrokeTakesNoLonger) {
  // An edge and then a dwell: squares of their samples would be minutes.
  std::mt19937_64 rng = test::test_rng();
  std::vector<Vec2> samples;
  for (int i = 0; i < 100'000; ++i) samples.emplace_back(1e-6 * i, 0.0);
  samples.insert(samples.end(), 100'000, samples.back());
  add_noise(1e-6, rng, &samples);
  EXPECT_FALSE(has_straight_end(samples));
}

}  // namespace
}  // namespace palpate
