// Corners and features of parts by strokes of few samples: where nobody states the noise, it must
// not take in the part's form, and no curve leads from wall to wall by a way that the probe has not
// gone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kWall = 0.03;  // [m]

/// Two bent walls that meet in a corner, evenly touched.
std::vector<Vec2> over_corner(int count, std::mt19937_64& rng) {
  constexpr int kFine = 2000;
  const auto wall = [&](double direction, double length) {
    const double bend = test::uniform(rng, -1.2, 1.2);
    const double change = test::uniform(rng, -1.0, 1.0);
    std::vector<Vec2> way{Vec2::Zero()};
    for (int i = 1; i < kFine; ++i) {
      const double s = length * i / kFine;
      const double angle = direction + bend * s + 0.5 * change * s * s;
      way.push_back(way.back() + kWall * length / kFine * Vec2(std::cos(angle), std::sin(angle)));
    }
    return way;
  };
  const double turn = test::uniform(rng, 25.0, 120.0) * kPi / 180.0;
  const double before = test::uniform(rng, 0.3, 1.0);
  const double after = test::uniform(rng, 0.3, 1.0);
  std::vector<Vec2> way = wall(kPi, before);
  std::reverse(way.begin(), way.end());
  const std::vector<Vec2> second = wall(turn, after);
  way.insert(way.end(), second.begin() + 1, second.end());
  const double step = kWall * (before + after) / (count - 1);
  std::vector<Vec2> places{way.front()};
  double gone = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    gone += (way[i] - way[i - 1]).norm();
    if (gone >= step) {
      gone -= step;
      places.push_back(way[i]);
    }
  }
  return places;
}

/// Of parts of no class, RECOGNIZED answers of one may be as many as these say.
void expect_honest(const std::string& name, bool stated_noise,
                   const std::function<std::vector<Vec2>(double, std::mt19937_64&)>& touched) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(300);
  int wrong = 0;
  double stated = 0.0;
  for (int i = 0; i < scenes; ++i) {
    const double sigma_m = kWall * test::log_uniform(rng, 1e-5, 1e-4);
    std::vector<ContactSample> samples;
    for (const Vec2& place : touched(sigma_m, rng)) {
      samples.push_back({place + test::normal_pair(rng, sigma_m), stated_noise ? sigma_m : 0.0, 0});
    }
    Recognizer recognizer;
    recognizer.add({}, samples);
    const Recognition answer = recognizer.recognize();
    if (test::is_recognized(answer)) {
      ++wrong;
      stated += test::stated_doubt(answer);
      std::cout << name << " " << i << ": " << samples.size() << " samples, " << test::said(answer)
                << "\n";
    }
  }
  std::cout << name << ": RECOGNIZED as a class " << wrong << " of " << scenes << "\n";
  EXPECT_LE(wrong, test::most_of_poisson(stated));
}

TEST(SparseParts, ACornerIsNoNoiseOfACubic) {
  expect_honest("corner", false, [](double, std::mt19937_64& rng) {
    return over_corner(30 + static_cast<int>(rng() % 35), rng);
  });
}

// A spline that crosses itself fits both walls, with a loop between them that no sample is on.
TEST(SparseParts, ACornerIsNoCubicWithALoop) {
  expect_honest("corner, stated", true, [](double, std::mt19937_64& rng) {
    return over_corner(30 + static_cast<int>(rng() % 130), rng);
  });
}

/// A ring touched all round, with a bump or a dent.
struct FeaturedRing {
  std::vector<ContactSample> samples;
  Vec2 feature_m;       ///< its middle
  double half_width_m;  ///< along the ring
};

FeaturedRing touched_ring(double sigma_m, std::mt19937_64& rng) {
  constexpr double kRadius = 0.02;  // [m]
  const int count = 36 + static_cast<int>(rng() % 25);
  const double half_width = kPi * test::log_uniform(rng, 0.03, 0.13);
  const double height_m = sigma_m * test::log_uniform(rng, 20.0, 100.0) * (rng() % 2 ? 1.0 : -1.0);
  const double middle = test::uniform(rng, 0.5, 1.5) * kPi;
  FeaturedRing ring{{}, kRadius * Vec2(std::cos(middle), std::sin(middle)), kRadius * half_width};
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * i / (count - 1);
    const double x = std::min(std::abs(angle - middle) / half_width, 1.0);
    const double radius = kRadius + height_m * (1.0 - x * x) * (1.0 - x * x);
    ring.samples.push_back(
        {radius * Vec2(std::cos(angle), std::sin(angle)) + test::normal_pair(rng, sigma_m), 0.0,
         0});
  }
  return ring;
}

// Where nobody states the noise, what most samples show is it. Those left beside the samples set
// aside lie within the limit, some six deviations, and are four at most, two on either flank: over
// thirty and more degrees of freedom they raise the noise to 2.4 times what it is, and its own
// scatter that by a third.
TEST(SparseParts, AFeatureOfARingIsNoNoiseOfACircle) {
  constexpr double kMostRaised = 4.0;
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(300);
  int recognized = 0;
  int set_aside = 0;
  int wrong = 0;
  double stated = 0.0;
  for (int i = 0; i < scenes; ++i) {
    const double sigma_m = test::log_uniform(rng, 2e-7, 2e-6);
    const FeaturedRing ring = touched_ring(sigma_m, rng);
    Recognizer recognizer;
    recognizer.add({}, ring.samples);
    const Recognition answer = recognizer.recognize();
    if (test::is_recognized(answer)) {
      ++recognized;
      set_aside += answer.outlier_count > 0 ? 1 : 0;
      stated += test::stated_doubt(answer);
      if (answer.sigma_m > kMostRaised * sigma_m) {
        ++wrong;
        std::cout << "ring " << i << ", noise " << sigma_m << " m: " << test::said(answer) << "\n";
      }
      for (const Vec2& place : answer.outliers_m) {
        EXPECT_LE((place - ring.feature_m).norm(), ring.half_width_m + 10.0 * sigma_m) << i;
      }
    }
  }
  std::cout << "rings with a feature: RECOGNIZED " << recognized << " of " << scenes << ", "
            << set_aside << " with samples of the feature set aside\n";
  EXPECT_LE(wrong, test::most_of_poisson(stated));
}

// Of an edge along an axis most readings are the same: their median tells no noise, and the others,
// a step away, are no form.
TEST(SparseParts, AnEdgeInStepsOfItsReadingsIsALine) {
  constexpr double kStep = 1e-6;  // [m]
  std::vector<ContactSample> samples;
  for (int i = 0; i < 200; ++i) {
    samples.push_back({{2e-4 * i, i % 50 < 5 ? kStep : 0.0}, 0.0, 0});
  }
  Recognizer recognizer;
  recognizer.add({}, samples);
  const Recognition answer = recognizer.recognize();
  EXPECT_EQ(answer.shape.curve_class, CurveClass::Line) << test::said(answer);
  EXPECT_EQ(answer.status, RecognitionStatus::Recognized) << test::said(answer);
}

// Its square is less than the sum of the others', however far off it is.
TEST(SparseParts, OneGrossTouchAmongManyIsSetAside) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kSigma = 1e-5;  // [m]
  for (int i = 0; i < test::stress_count(10); ++i) {
    Recognizer recognizer;
    constexpr std::uint32_t kTouches = 100;
    for (std::uint32_t k = 0; k < kTouches; ++k) {
      const double t = test::uniform(rng, 0.0, 2.0 * kPi);
      const double off = k == 0 ? 10.0 * kSigma : 0.0;
      PatchContext context;
      context.patch = k;
      recognizer.add(context,
                     std::vector<ContactSample>{{(0.02 + off) * Vec2(std::cos(t), std::sin(t)) +
                                                     test::normal_pair(rng, kSigma),
                                                 0.0, 0}});
    }
    const Recognition answer = recognizer.recognize();
    EXPECT_EQ(answer.outlier_count, 1U) << test::said(answer);
  }
}

}  // namespace
}  // namespace palpate
