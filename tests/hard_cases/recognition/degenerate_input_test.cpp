// Inputs that contain no curve, or a curve at the limits of a double: no answer may be certain, and
// probabilities must remain valid.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answer_invariants.h"
#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

Recognition stroked(const std::vector<Vec2>& positions, double sigma_m) {
  Recognizer recognizer;
  std::vector<ContactSample> samples;
  for (const Vec2& position : positions) {
    samples.push_back({position, sigma_m, 0});
  }
  recognizer.add({}, samples);
  return recognizer.recognize();
}

std::string broken(const Recognition& answer, const std::vector<Vec2>& positions) {
  return test::broken_invariant(answer, test::places_of(positions));
}

void expect_certain_of_nothing(const Recognition& answer, const std::vector<Vec2>& positions) {
  EXPECT_EQ(broken(answer, positions), "");
  EXPECT_NE(answer.status, RecognitionStatus::Recognized);
}

/// 111 samples over a quarter of an ellipse with a = size around `about`, by formula.
std::vector<Vec2> quarter_of_ellipse(double size, const Vec2& about) {
  std::vector<Vec2> positions;
  for (int i = 0; i < 111; ++i) {
    const double t = 0.3 + 0.0143 * i;
    positions.push_back(about + size * Vec2(std::cos(t), 0.7 * std::sin(t)));
  }
  return positions;
}

/// Stated noise: usual, far too small and far too large; 0 = not stated. [m]
constexpr double kStated[] = {2e-5, 1e-15, 1e-9, 1e3, 0.0};

TEST(DegenerateInput, NineTouchesOfOnePlaceAreNoCurve) {
  for (const double sigma_m : kStated) {
    for (const Vec2& place : {Vec2(0.1, -0.03), Vec2(0.0, 0.0), Vec2(1e6, 1e-6)}) {
      SCOPED_TRACE(testing::Message() << "sigma " << sigma_m << " at " << place.transpose());
      const std::vector<Vec2> positions(9, place);
      expect_certain_of_nothing(test::answer_to_touches(positions, sigma_m), positions);
    }
  }
}

TEST(DegenerateInput, TwoPlacesAreNoCurve) {
  std::vector<Vec2> positions;
  for (int i = 0; i < 200; ++i) {
    positions.emplace_back(0.1 + 0.01 * (i % 2), -0.03);
  }
  for (const double sigma_m : kStated) {
    SCOPED_TRACE(sigma_m);
    expect_certain_of_nothing(test::answer_to_touches(positions, sigma_m), positions);
    expect_certain_of_nothing(stroked(positions, sigma_m), positions);
  }
}

TEST(DegenerateInput, SevenPlacesTouchedAgainAndAgainAreNoCurve) {
  std::vector<Vec2> positions;
  for (int i = 0; i < 210; ++i) {
    const double t = 0.4 * (i % 7);
    positions.emplace_back(0.025 * std::cos(t), 0.025 * std::sin(t));
  }
  for (const double sigma_m : kStated) {
    SCOPED_TRACE(sigma_m);
    expect_certain_of_nothing(stroked(positions, sigma_m), positions);
  }
}

TEST(DegenerateInput, AnExtentAtRoundingIsNoCurve) {
  // Steps of one unit in the last place of the coordinates.
  for (const double coordinate : {0.1, 1e6, 1e-6}) {
    std::vector<Vec2> positions;
    Vec2 place(coordinate, coordinate);
    for (int i = 0; i < 12; ++i) {
      positions.push_back(place);
      place.x() = std::nextafter(place.x(), std::numeric_limits<double>::infinity());
      place.y() = std::nextafter(place.y(), i % 3 == 0 ? 0.0 : place.y());
    }
    for (const double sigma_m : kStated) {
      SCOPED_TRACE(testing::Message() << "sigma " << sigma_m << " at " << coordinate);
      expect_certain_of_nothing(stroked(positions, sigma_m), positions);
    }
  }
}

TEST(DegenerateInput, PatchesAtTheLimitsOfADoubleKeepProbabilitiesFinite) {
  for (const double size : {1e-155, 1e-150, 1e-100, 1e100, 1e150, 1e155}) {
    for (const double stated : {0.0, 1e-5, 1.0}) {
      SCOPED_TRACE(testing::Message() << size << " m, sigma/size " << stated);
      const std::vector<Vec2> positions = quarter_of_ellipse(size, {0.0, 0.0});
      EXPECT_EQ(broken(stroked(positions, stated * size), positions), "");
    }
  }
}

TEST(DegenerateInput, APatchTooSmallForItsCoordinatesIsNoCurve) {
  for (const double size : {1e-150, 1e-20, 1e-17}) {
    const std::vector<Vec2> positions = quarter_of_ellipse(size, {0.1, -0.03});
    for (const double sigma_m : {0.0, 1e-20, 2e-5}) {
      SCOPED_TRACE(testing::Message() << size << " m, sigma " << sigma_m);
      expect_certain_of_nothing(stroked(positions, sigma_m), positions);
    }
  }
}

TEST(DegenerateInput, IdenticalCollinearSteps) {
  for (const int count : {8, 9, 40, 111}) {
    std::vector<Vec2> positions;
    for (int i = 0; i < count; ++i) {
      positions.emplace_back(i / 1024.0, i / 2048.0);  // exactly on a line
    }
    for (const double sigma_m : kStated) {
      SCOPED_TRACE(testing::Message() << count << " samples, sigma " << sigma_m);
      const Recognition answer = stroked(positions, sigma_m);
      EXPECT_EQ(broken(answer, positions), "");
      if (answer.status == RecognitionStatus::Recognized) {
        EXPECT_EQ(answer.shape.curve_class, CurveClass::Line);
      }
      const Recognition apart = test::answer_to_touches(positions, sigma_m);
      EXPECT_EQ(broken(apart, positions), "");
    }
  }
}

// All samples of the last patch may be set aside as spikes, which leaves an empty patch.
TEST(DegenerateInput, APatchOfSpikesOnly) {
  const std::vector<Vec2> good = quarter_of_ellipse(0.025, {0.1, -0.03});
  for (const std::size_t count : {1U, 2U, 3U}) {
    for (const bool first : {false, true}) {
      SCOPED_TRACE(testing::Message() << count << (first ? " first" : " last"));
      Recognizer recognizer;
      std::vector<Vec2> positions = good;
      const auto add = [&](std::uint32_t patch, std::span<const Vec2> places) {
        std::vector<ContactSample> samples;
        for (const Vec2& place : places) {
          samples.push_back({place, 2e-6, 0});
        }
        PatchContext context;
        context.patch = patch;
        recognizer.add(context, samples);
      };
      std::vector<Vec2> spikes;
      for (std::size_t i = 0; i < count; ++i) {
        spikes.emplace_back(0.16 + 0.004 * static_cast<double>(i * i),
                            0.02 * static_cast<double>(i));
      }
      positions.insert(positions.end(), spikes.begin(), spikes.end());
      if (first) {
        add(9, spikes);
      }
      add(1, std::span(good).first(55));
      add(2, std::span(good).subspan(55));
      if (!first) {
        add(9, spikes);
      }
      EXPECT_EQ(broken(recognizer.recognize(), positions), "");
    }
  }
}

TEST(DegenerateInput, WhatIsNotFiniteIsRefusedAndSaid) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Recognizer recognizer;
  std::vector<ContactSample> samples;
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    samples.push_back({{bad, 0.0}, 2e-5, 0});
    samples.push_back({{0.0, bad}, 2e-5, 0});
    samples.push_back({{0.0, 0.0}, bad, 0});
  }
  const AddResult result = recognizer.add({}, samples);
  EXPECT_EQ(result.accepted, 0U);
  EXPECT_EQ(result.rejected_not_finite + result.rejected_negative_sigma, samples.size());
  const Recognition answer = recognizer.recognize();
  EXPECT_EQ(answer.status, RecognitionStatus::Collecting);
  EXPECT_EQ(answer.sample_count, 0U);
}

// A probe at rest far from the origin: the samples scatter by more than the tip, and neither a
// class nor a free form has evidence.
TEST(DegenerateInput, ARestingProbeFarAwayIsNoCurve) {
  auto rng = test::test_rng();
  std::normal_distribution<double> scatter_m(0.0, 4.5e-6);
  const int runs = test::stress_count(8);
  for (int run = 0; run < runs; ++run) {
    std::vector<Vec2> positions;
    std::vector<ContactSample> samples;
    for (int i = 0; i < 1582; ++i) {
      positions.push_back(Vec2(2567500.0, -770250.0) + Vec2(scatter_m(rng), scatter_m(rng)));
      samples.push_back({positions.back(), 2.1e-8, 0});
    }
    Recognizer recognizer;
    PatchContext context;
    context.tip_radius_m = 5.4e-6;
    recognizer.add(context, samples);
    expect_certain_of_nothing(recognizer.recognize(), positions);
  }
}

}  // namespace
}  // namespace palpate
