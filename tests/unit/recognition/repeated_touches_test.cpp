// Which single touches are of one place, and what stands for them.
#include "core/recognition/samples/cleaned/repeated_touches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "core/recognition/samples/cleaned/chained_touches.h"
#include "core/recognition/samples/cleaned/clean_patches.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

constexpr double kOneSigma = 1e-5;  // [m]

StoredPatch touch_at(const Vec2& place_m, double sigma_m = kOneSigma) {
  StoredPatch patch;
  patch.samples.push_back({place_m, sigma_m, 1.0});
  patch.newest_m = place_m;
  return patch;
}

StoredPatch with_normal(StoredPatch touch, double angle, double normal_sigma_rad) {
  SampleDetail detail;
  detail.normal = Vec2(std::cos(angle), std::sin(angle));
  detail.normal_sigma_rad = normal_sigma_rad;
  touch.details.push_back(detail);
  return touch;
}

std::vector<StoredPatch> numbered(std::vector<StoredPatch> patches) {
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].context.patch = static_cast<std::uint32_t>(p);
  }
  return patches;
}

std::vector<StoredPatch> without_repeated_touches(std::vector<StoredPatch> patches,
                                                  double default_sigma_m) {
  std::vector<StoredPatch> clean = patches;
  merge_repeated_touches(default_sigma_m, &patches, &clean);
  EXPECT_EQ(patches, clean);
  return clean;
}

std::size_t places_of(std::vector<StoredPatch> patches, double default_sigma_m = 0.0) {
  return without_repeated_touches(numbered(std::move(patches)), default_sigma_m).size();
}

TEST(RepeatedTouches, WithinTheirNoiseAreOneSampleWhereTheFirstWas) {
  const Vec2 place(0.3, -0.2);
  const Vec2 x(kOneSigma, 0.0);
  const Vec2 y(0.0, kOneSigma);
  // The touches at the place are first, third and last; others lie elsewhere.
  const auto result = without_repeated_touches(
      numbered({touch_at(place - x), touch_at(place + 1000.0 * x), touch_at(place + x - y),
                touch_at(place - 1000.0 * y), touch_at(place + y)}),
      0.0);
  ASSERT_EQ(result.size(), 3U);
  EXPECT_EQ(result[0].context.patch, 0U);
  EXPECT_EQ(result[1].context.patch, 1U);
  EXPECT_EQ(result[2].context.patch, 3U);
  ASSERT_EQ(result[0].samples.size(), 1U);
  const StoredSample& mean = result[0].samples.front();
  EXPECT_LT((mean.position_m - place).norm(), 1e-6 * kOneSigma);
  EXPECT_DOUBLE_EQ(mean.weight, 3.0);
  EXPECT_DOUBLE_EQ(mean.contacts, 3.0);
  EXPECT_DOUBLE_EQ(mean.sigma_m, kOneSigma);  // of one of them
  EXPECT_EQ(result[1].samples.front().weight, 1.0);
  EXPECT_EQ(result[1].samples.front().position_m, Vec2(place + 1000.0 * x));
}

TEST(RepeatedTouches, AreApartWhereNoiseSeldomPutsThem) {
  // kOnePlace deviations of a difference, which are the root of two larger than a touch's.
  const double most = kOnePlace * std::sqrt(2.0) * kOneSigma;
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), touch_at({0.99 * most, 0.0})}), 1U);
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), touch_at({1.01 * most, 0.0})}), 2U);
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), touch_at({0.0, -0.99 * most})}), 1U);
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), touch_at({0.0, -1.01 * most})}), 2U);
  // A coarse probe and a fine one.
  const double of_both = kOnePlace * std::hypot(kOneSigma, 10.0 * kOneSigma);
  const StoredPatch coarse = touch_at({0.99 * of_both, 0.0}, 10.0 * kOneSigma);
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), coarse}), 1U);
  EXPECT_EQ(places_of({touch_at({-0.02 * of_both, 0.0}), coarse}), 2U);
}

TEST(RepeatedTouches, OfOnePlaceStayApartOnceInAThousandTimes) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kOneSigma);
  constexpr double kRare = 1e-3;
  for (const int touches : {2, 3, 5, 10}) {
    const int places = test::stress_count(2000);
    int apart = 0;
    for (int i = 0; i < places; ++i) {
      std::vector<StoredPatch> patches;
      for (int k = 0; k < touches; ++k) {
        const double x = noise(rng);
        patches.push_back(touch_at({x, noise(rng)}));
      }
      apart += places_of(patches) > 1 ? 1 : 0;
    }
    // Each pair is farther apart than noise once in a thousand times, and all together scatter more
    // as often. Four deviations of so rare counts, and one.
    const double expected = (touches * (touches - 1) / 2 + 1) * kRare * places;
    EXPECT_LE(apart, expected + 4.0 * std::sqrt(expected) + 1.0) << touches;
  }
}

TEST(RepeatedTouches, OfNoStatedNoiseStayAsTheyAre) {
  const std::vector<StoredPatch> touches{touch_at({0.0, 0.0}, 0.0), touch_at({0.0, 0.0}, 0.0),
                                         touch_at({1e-9, 0.0}, 0.0)};
  EXPECT_EQ(places_of(touches), 3U);
  EXPECT_EQ(places_of(touches, kOneSigma), 1U);
  // One that states its noise has nothing to be compared with.
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), touch_at({0.0, 0.0}, 0.0)}), 2U);
}

TEST(RepeatedTouches, OfDifferentTipsStayAsTheyAre) {
  StoredPatch by_tip = touch_at({0.0, 0.0});
  by_tip.context.tip_radius_m = 1e-3;
  StoredPatch sided = touch_at({0.0, 0.0});
  sided.context.material_side = MaterialSide::Left;
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), by_tip}), 2U);
  EXPECT_EQ(places_of({touch_at({0.0, 0.0}), sided}), 2U);
  EXPECT_EQ(places_of({by_tip, sided, by_tip, sided}), 2U);
}

// Of a stroke whose other samples are spikes one is left, beside a touch; of a touch that is one,
// nothing. They were merged on one side alone, and all later patches stood beside others.
TEST(RepeatedTouches, AreThoseThatNoSpikesHaveMade) {
  StoredPatch stroke = touch_at({0.0, 0.0});
  stroke.samples.push_back({{100.0 * kOneSigma, 0.0}, kOneSigma, 1.0});
  StoredPatch spike = touch_at({0.0, 0.0});
  spike.samples.clear();
  const StoredPatch touch = touch_at({0.0, 0.0});
  const StoredPatch last = touch_at({1.0, 0.0});
  std::vector<StoredPatch> moved = numbered({stroke, touch, touch, touch, last});
  std::vector<StoredPatch> clean = numbered({touch, touch, spike, touch, last});
  merge_repeated_touches(0.0, &moved, &clean);
  ASSERT_EQ(moved.size(), 4U);
  ASSERT_EQ(clean.size(), 4U);
  for (std::size_t p = 0; p < clean.size(); ++p) {
    EXPECT_EQ(moved[p].context.patch, clean[p].context.patch) << p;
  }
  EXPECT_EQ(moved[0].samples.size(), 2U);
  EXPECT_EQ(clean[0].samples.size(), 1U);
  EXPECT_EQ(clean[1].samples.front().weight, 2.0);
  EXPECT_EQ(moved[1], clean[1]);
  EXPECT_TRUE(clean[2].samples.empty());
  EXPECT_EQ(clean[3].context.patch, 4U);
}

TEST(RepeatedTouches, OfOtherNormalsStayAsTheyAre) {
  constexpr double kNormalSigma = 0.02;  // [rad]
  const auto normal = [](double angle) {
    return with_normal(touch_at({0.0, 0.0}), angle, kNormalSigma);
  };
  const double most = kOnePlace * std::sqrt(2.0) * kNormalSigma;
  EXPECT_EQ(places_of({normal(0.5), normal(0.5 + 0.99 * most)}), 1U);
  EXPECT_EQ(places_of({normal(0.5), normal(0.5 + 1.01 * most)}), 2U);
  EXPECT_EQ(places_of({normal(0.5), normal(0.5 + kPi)}), 2U);  // the two sides of a thin wall
  EXPECT_EQ(places_of({normal(0.5), touch_at({0.0, 0.0})}), 2U);
  const auto merged = without_repeated_touches(numbered({normal(0.48), normal(0.52)}), 0.0);
  ASSERT_EQ(merged.size(), 1U);
  ASSERT_EQ(merged.front().details.size(), 1U);
  const SampleDetail& detail = merged.front().details.front();
  EXPECT_NEAR(std::atan2(detail.normal.y(), detail.normal.x()), 0.5, 1e-6);
  EXPECT_NEAR(detail.normal_sigma_rad, kNormalSigma / std::sqrt(2.0), 1e-6);
}

/// Six deviations from one to the next: farther than noise puts two of one place.
TEST(RepeatedTouches, AlongACurveStayAsTheyAre) {
  for (const double angle : {0.0, 0.7, 0.5 * kPi}) {
    std::vector<StoredPatch> touches;
    for (int i = 0; i < 100; ++i) {
      touches.push_back(touch_at(6.0 * i * kOneSigma * Vec2(std::cos(angle), std::sin(angle))));
    }
    EXPECT_EQ(places_of(touches), touches.size()) << angle;
  }
}

/// However close they are: noise puts many of them next to each other, but none of them apart from
/// the rest.
TEST(RepeatedTouches, DenselyAlongACurveStayAsTheyAre) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kOneSigma);
  for (const double angle : {0.0, 0.7, 0.5 * kPi}) {
    for (const double step : {0.02, 0.1, 0.5}) {  // in deviations
      std::vector<StoredPatch> touches;
      for (int i = 0; i * step < 200.0; ++i) {
        const double x = noise(rng);
        const Vec2 place = step * i * kOneSigma * Vec2(std::cos(angle), std::sin(angle));
        touches.push_back(touch_at(place + Vec2(x, noise(rng))));
      }
      std::shuffle(touches.begin(), touches.end(), rng);
      EXPECT_EQ(places_of(touches), touches.size()) << angle << ", " << step;
    }
  }
}

TEST(RepeatedTouches, ManyTimesAtManyPlacesAreThesePlaces) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kOneSigma);
  constexpr int kPlaces = 12;
  std::vector<StoredPatch> touches;
  for (int i = 0; i < 300 * kPlaces; ++i) {
    const double x = noise(rng);
    touches.push_back(touch_at(20.0 * kOneSigma * Vec2(i % kPlaces, 0.0) + Vec2(x, noise(rng))));
  }
  // Noise puts a touch so far from all others of its place less than once in a thousand times, and
  // makes a place scatter too much to be one as seldom.
  const std::size_t places = places_of(touches);
  EXPECT_LE(places, kPlaces + 4U);
  EXPECT_GE(places, std::size_t{kPlaces});
}

TEST(RepeatedTouches, OfStrokesAreNoTouches) {
  StoredPatch stroke = touch_at({0.0, 0.0});
  stroke.samples.push_back({Vec2(1e-3, 0.0), kOneSigma, 1.0});
  EXPECT_EQ(places_of({stroke, touch_at({0.0, 0.0}), stroke}), 3U);
  EXPECT_EQ(places_of({}), 0U);
  EXPECT_EQ(places_of({touch_at({0.0, 0.0})}), 1U);
}

TEST(RepeatedTouches, AreAllAccountedFor) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kOneSigma);
  std::vector<StoredPatch> touches;
  for (int i = 0; i < 40; ++i) {
    const Vec2 place(std::cos(i % 9), std::sin(i % 9));
    const double x = noise(rng);
    touches.push_back(touch_at(0.02 * place + Vec2(x, noise(rng))));
  }
  touches = numbered(std::move(touches));
  CleanPatches clean;
  clean.update(touches, {.false_alarm = 0.01}, test::unbounded_work());
  EXPECT_LT(clean.moved_count(), touches.size());
  EXPECT_EQ(clean.moved_count() + clean.dwelling_count(), touches.size());
}

TEST(CleanPatches, KeepNothingOfATipThatIsAnother) {
  StoredPatch stroke;
  for (int i = 0; i < 40; ++i) {
    stroke.samples.push_back({0.02 * Vec2(std::cos(0.05 * i), std::sin(0.05 * i)), kOneSigma});
  }
  stroke.newest_m = stroke.samples.back().position_m;
  CleanPatches clean;
  clean.update({&stroke, 1}, {.false_alarm = 0.01}, test::unbounded_work());
  stroke.context.material_side = MaterialSide::Left;
  stroke.context.tip_radius_m = 1e-3;
  clean.update({&stroke, 1}, {.false_alarm = 0.01}, test::unbounded_work());
  EXPECT_EQ(clean.moved().front().context, stroke.context);
  EXPECT_EQ(clean.clean().front().context, stroke.context);
}

}  // namespace
}  // namespace palpate
