// Strokes far out on the arms of parabolas and cubics, or on the tips of long ellipses, where other
// classes leave as little.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iostream>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr int kSamples = 80;

/// From where to where a stroke runs, by the curve's parameter.
using Stroke = std::array<double, 2>;

Recognition touched(const Curve& curve, std::span<const Stroke> strokes, double sigma_m,
                    std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  Recognizer recognizer;
  std::uint32_t patch = 0;
  for (const auto& [begin, end] : strokes) {
    std::vector<ContactSample> samples;
    for (int i = 0; i < kSamples; ++i) {
      const double t = begin + (end - begin) * i / (kSamples - 1.0);
      const double x = noise(rng);
      samples.push_back({position(curve, t) + Vec2(x, noise(rng)), sigma_m, 0});
    }
    recognizer.add({0, patch++}, samples);
  }
  return recognizer.recognize();
}

struct FarArms {
  std::string name;
  std::function<Curve(std::mt19937_64&)> part;
  std::vector<Stroke> strokes;
  double sigma_m;
};

void PrintTo(const FarArms& of, std::ostream* out) { *out << of.name; }

/// How many answers are RECOGNIZED as another class, what they state of that, and how many leave
/// the truth less than one in ten thousand.
struct Told {
  int wrong = 0;
  double stated_wrong = 0.0;
  int improbable = 0;
};

constexpr double kImprobable = 1e-4;

Told told_of(const FarArms& parts, int scenes) {
  std::mt19937_64 rng = test::test_rng();
  Told told;
  int right = 0;
  for (int i = 0; i < scenes; ++i) {
    const Curve curve = parts.part(rng);
    const Recognition answer = touched(curve, parts.strokes, parts.sigma_m, rng);
    if (answer.status == RecognitionStatus::Recognized) {
      (answer.shape.curve_class == class_of(curve) ? right : told.wrong) += 1;
      told.stated_wrong += 1.0 - answer.hypotheses.front().probability;
    }
    double of_truth = 0.0;
    for (const Hypothesis& hypothesis : answer.hypotheses) {
      of_truth += hypothesis.shape.curve_class == class_of(curve) ? hypothesis.probability : 0.0;
    }
    told.improbable += of_truth < kImprobable ? 1 : 0;
  }
  std::cout << parts.name << ": of " << scenes << " RECOGNIZED " << right << ", as another "
            << told.wrong << " (as told " << told.stated_wrong << "), improbable "
            << told.improbable << '\n';
  return told;
}

class FarArmsOf : public testing::TestWithParam<FarArms> {};

// If all of the prior were parts that end where their slope is 3, these had e^-10 of it, and
// another class, which leaves as little, all of the answer.
TEST_P(FarArmsOf, AreTakenForNoOtherClass) {
  const int scenes = test::stress_count(80);
  const Told told = told_of(GetParam(), scenes);
  EXPECT_LE(told.wrong, test::most_of_poisson(told.stated_wrong));
  EXPECT_LE(told.improbable, test::most_of_poisson(kImprobable * scenes));
}

// This far from its other end an ellipse is a parabola but for its m, of which such needles have a
// thirtieth: rightly the parabola is the more probable, but no more than by that.
TEST(FarArms, TipsOfNeedlesAreNotImprobable) {
  const FarArms needles{"tips of needles",
                        [](std::mt19937_64& rng) -> Curve {
                          const double a_m = test::uniform(rng, 0.1, 0.4);
                          return Ellipse{a_m, test::uniform(rng, 0.010, 0.018)};
                        },
                        {{-0.15, -0.08}, {-0.05, 0.05}, {0.08, 0.15}},
                        2e-6};
  const int scenes = test::stress_count(80);
  EXPECT_LE(told_of(needles, scenes).improbable, test::most_of_poisson(kImprobable * scenes));
}

// Lengths in metres; a of the cubical parabola in 1 / m^2.
INSTANTIATE_TEST_SUITE_P(
    Parts, FarArmsOf,
    testing::Values(FarArms{"flanks of slope 1 to 80",
                            [](std::mt19937_64& rng) -> Curve {
                              const double a =
                                  test::random_sign(rng) * test::log_uniform(rng, 3e3, 3e4);
                              return CubicalParabola{a, test::uniform(rng, -1.0, 1.0)};
                            },
                            {{0.010, 0.014}, {0.016, 0.020}, {0.024, 0.030}},
                            2e-5},
                    FarArms{"inflections of slope 5 to 15",
                            [](std::mt19937_64& rng) -> Curve {
                              return CubicalParabola{1e4, test::uniform(rng, 5.0, 15.0)};
                            },
                            {{-0.030, -0.015}, {-0.010, 0.010}, {0.024, 0.030}},
                            2e-5},
                    FarArms{"one leg of a parabola",
                            [](std::mt19937_64& rng) -> Curve {
                              return Parabola{test::uniform(rng, 1e-4, 3e-4)};
                            },
                            {{6.0, 8.0}, {9.0, 11.0}, {12.0, 15.0}},
                            5e-6},
                    FarArms{"both legs of a parabola",
                            [](std::mt19937_64& rng) -> Curve {
                              return Parabola{test::uniform(rng, 1e-4, 3e-4)};
                            },
                            {{-15.0, -11.0}, {-9.0, -6.0}, {6.0, 15.0}},
                            2e-5},
                    FarArms{"a leg and the tip of a needle",
                            [](std::mt19937_64& rng) -> Curve {
                              return Parabola{test::uniform(rng, 1e-6, 4e-6)};
                            },
                            {{-15.0, 22.0}, {60.0, 90.0}, {110.0, 150.0}},
                            1e-6}),
    [](const testing::TestParamInfo<FarArms>& of) {
      std::string name = of.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

}  // namespace
}  // namespace palpate
