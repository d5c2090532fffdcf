// Habits of probes other than one even stroke: holding a touch, standing still, going back and
// forth, going round several times, and few samples near a cusp.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kNoiseOfHabit = 1e-5;  // [m]

/// An ellipse a few centimetres across, touched from a random place on.
struct Part {
  double a, b, start;

  explicit Part(std::mt19937_64& rng) {
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(rng);
    };
    a = uniform(0.02, 0.05);
    b = a * uniform(0.4, 0.8);
    start = uniform(0.0, 2.0 * kPi);
  }

  Vec2 at(double angle) const { return {a * std::cos(start + angle), b * std::sin(start + angle)}; }
};

using Places = std::vector<std::vector<Vec2>>;  ///< by patch

struct Tally {
  int right = 0;
  int wrong = 0;
  std::size_t dwelling = 0;
};

/// Answers to ellipse scenes, with the noise stated and not stated.
Tally answers_to(const std::function<Places(const Part&, std::mt19937_64&)>& touched) {
  constexpr int kScenes = 30;
  std::mt19937_64 rng(11);
  std::normal_distribution<double> noise(0.0, kNoiseOfHabit);
  Tally tally;
  for (int scene = 0; scene < kScenes; ++scene) {
    const Part part(rng);
    const Places places = touched(part, rng);
    Recognizer recognizer;
    for (std::size_t p = 0; p < places.size(); ++p) {
      PatchContext context;
      context.patch = static_cast<std::uint32_t>(p);
      std::vector<ContactSample> samples;
      for (const Vec2& place : places[p]) {
        const double x = noise(rng);
        samples.push_back({place + Vec2(x, noise(rng)), scene % 2 == 0 ? kNoiseOfHabit : 0.0, 0});
      }
      recognizer.add(context, samples);
    }
    const Recognition answer = recognizer.recognize();
    const bool recognized = answer.status == RecognitionStatus::Recognized;
    const bool ellipse = answer.shape.curve_class == CurveClass::Ellipse;
    tally.right += recognized && ellipse ? 1 : 0;
    tally.wrong += recognized && !ellipse ? 1 : 0;
    tally.dwelling = std::max(tally.dwelling, answer.dwelling_count);
  }
  // Each scene is determined. One in twenty may remain ambiguous; more than 6 of 30 occur once in
  // 3,000 runs.
  EXPECT_GE(tally.right, 24);
  EXPECT_EQ(tally.wrong, 0);
  return tally;
}

TEST(Habits, TouchesThatAreHeld) {
  const Tally tally = answers_to([](const Part& part, std::mt19937_64&) {
    Places places;
    for (int k = 0; k < 20; ++k) {
      places.emplace_back(100, part.at(2.0 * kPi * k / 20));
    }
    return places;
  });
  EXPECT_EQ(tally.dwelling, 20U * 99U);
}

TEST(Habits, AProbeThatStandsStillAmidItsStroke) {
  for (const std::size_t standing : {130U, 1200U, 6000U}) {
    SCOPED_TRACE(standing);
    const Tally tally = answers_to([&](const Part& part, std::mt19937_64& rng) {
      std::vector<Vec2> stroke;
      const auto at = std::uniform_int_distribution<int>(0, 299)(rng);
      for (int i = 0; i < 300; ++i) {
        stroke.insert(stroke.end(), i == at ? standing : 1U, part.at(3.0 * i / 300));
      }
      return Places{stroke};
    });
    EXPECT_NEAR(static_cast<double>(tally.dwelling), static_cast<double>(standing), 10.0);
  }
}

TEST(Habits, StrokesThatGoThereAndBack) {
  for (const int passes : {2, 3, 6}) {
    SCOPED_TRACE(passes);
    answers_to([&](const Part& part, std::mt19937_64&) {
      std::vector<Vec2> stroke;
      for (int i = 0; i < 60 * passes; ++i) {
        const double way = i / 60.0;
        const double share = way - std::floor(way);
        stroke.push_back(part.at(3.0 * (i / 60 % 2 == 0 ? share : 1.0 - share)));
      }
      return Places{stroke};
    });
  }
}

TEST(Habits, AFullTurnThreeTimes) {
  answers_to([](const Part& part, std::mt19937_64&) {
    std::vector<Vec2> stroke;
    for (int i = 0; i < 450; ++i) {
      stroke.push_back(part.at(2.0 * kPi * i / 150));
    }
    return Places{stroke};
  });
}

TEST(Habits, FewSamplesBesideACusp) {
  // The spline has a semi-cubical parabola as its limit. When the search reached only one of them,
  // its probability was 1.
  std::ifstream in(std::string(PALPATE_TEST_DATA) + "/hostile/misleading_cusp_58.csv");
  ASSERT_TRUE(in.good());
  Recognizer recognizer;
  std::string line;
  std::getline(in, line);  // probe,patch,x_m,y_m,sigma_m
  while (std::getline(in, line)) {
    PatchContext context;
    ContactSample sample;
    ASSERT_EQ(std::sscanf(line.c_str(), "p,%u,%lf,%lf,%lf", &context.patch, &sample.position_m.x(),
                          &sample.position_m.y(), &sample.sigma_m),
              4);
    recognizer.add(context, std::span(&sample, 1));
  }
  const Recognition answer = recognizer.recognize();
  EXPECT_EQ(answer.sample_count, 58U);
  EXPECT_EQ(answer.shape.curve_class, CurveClass::SemiCubicalParabola);
}

// An edge that lies nearly along an axis of the machine reads the same for many samples, and then
// one step more. It was taken for noiseless, and every other sample for a spike.
TEST(Habits, AnEdgeAlongAnAxisOfAMachineThatRounds) {
  constexpr double kStep_m = 1e-5;
  std::mt19937_64 rng(test::test_seed());
  std::normal_distribution<double> noise(0.0, 0.1 * kStep_m);
  const auto rounded = [&](double v) { return kStep_m * std::round((v + noise(rng)) / kStep_m); };
  for (const double slope : {0.0, 1e-4, 1e-3, -3e-3}) {
    Recognizer recognizer;
    for (std::uint32_t patch = 0; patch < 2; ++patch) {
      std::vector<ContactSample> samples;
      for (int i = 0; i < 150; ++i) {
        const double x = 0.03 * patch + 1.37e-4 * i;
        ContactSample sample;
        sample.position_m = {rounded(0.2 + x), rounded(0.1 + slope * x)};
        samples.push_back(sample);
      }
      PatchContext context;
      context.patch = patch;
      recognizer.add(context, samples);
    }
    const Recognition answer = recognizer.recognize();
    EXPECT_FALSE(answer.work.was_cut()) << slope;
    EXPECT_EQ(answer.outlier_count, 0U) << slope;
    EXPECT_EQ(answer.shape.curve_class, CurveClass::Line) << slope;
    EXPECT_NEAR(answer.sigma_m, kStep_m / std::sqrt(12.0), 0.3 * kStep_m) << slope;
  }
}

}  // namespace
}  // namespace palpate
