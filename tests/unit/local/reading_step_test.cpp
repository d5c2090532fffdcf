// Readings rounded to a step, and what is none.
#include "core/local/reading_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// A line a tenth of a metre long, to the nearest multiple of `step_m` if that is not 0.
std::vector<Vec2> line(double step_m, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, 1e-6);
  const auto rounded = [&](double v) { return step_m > 0.0 ? std::round(v / step_m) * step_m : v; };
  std::vector<Vec2> samples;
  for (int i = 0; i < 100; ++i) {
    const double x = rounded(0.123456789 + 1.0123e-3 * i + noise(rng));
    samples.emplace_back(x, rounded(-0.31 + 2.3457e-4 * i + noise(rng)));
  }
  return samples;
}

TEST(ReadingStep, IsFoundInMillimetresAndInches) {
  auto rng = test::test_rng();
  for (const double step_m :
       {1e-4, 5e-5, 2.54e-5, 2.5e-4, 1.25e-4, 1e-5, 2.54e-6, 2e-6, 1e-6, 5e-8, 1e-9}) {
    EXPECT_NEAR(reading_step_m(line(step_m, rng)) / step_m, 1.0, 1e-12) << step_m;
  }
}

// Of a tool, or of another origin, after the rounding.
TEST(ReadingStep, IsFoundBesideAnOffsetAndInSinglePrecision) {
  auto rng = test::test_rng();
  for (const double step_m : {1e-4, 1.25e-4, 1e-5}) {
    std::vector<Vec2> moved = line(step_m, rng);
    std::vector<Vec2> single = line(step_m, rng);
    for (Vec2& sample : moved) sample += Vec2(0.0123456789, -0.0987654321);
    for (Vec2& sample : single) sample = sample.cast<float>().cast<double>();
    EXPECT_NEAR(reading_step_m(moved) / step_m, 1.0, 1e-12) << step_m;
    EXPECT_NEAR(reading_step_m(single) / step_m, 1.0, 1e-12) << step_m;
  }
}

TEST(ReadingStep, IsNoneOfReadingsInFullNorOfFewDigits) {
  auto rng = test::test_rng();
  EXPECT_EQ(reading_step_m(line(0.0, rng)), 0.0);
  EXPECT_EQ(reading_step_m({}), 0.0);
  const std::vector<Vec2> square = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  EXPECT_LE(reading_step_m(square), 0.01);
  EXPECT_EQ(reading_step_m({square.data(), 1}), 0.0);
}

// A dwell is replaced by its mean, which is no multiple.
TEST(ReadingStep, IsThatOfNineTenthsOfTheCoordinates) {
  auto rng = test::test_rng();
  std::vector<Vec2> samples = line(1e-5, rng);
  for (std::size_t i = 0; i < samples.size(); i += 12) samples[i] += Vec2(1.23e-6, 2.34e-6);
  EXPECT_NEAR(reading_step_m(samples), 1e-5, 1e-17);
  for (std::size_t i = 1; i < samples.size(); i += 12) samples[i] += Vec2(1.23e-6, 2.34e-6);
  EXPECT_LT(reading_step_m(samples), 1e-7);  // that of these numbers
}

}  // namespace
}  // namespace palpate
