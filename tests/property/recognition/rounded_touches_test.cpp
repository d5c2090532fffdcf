// Touches whose noise nobody states, with coordinates in few digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "core/local/reading_step.h"
#include "core/numerics/probability/negligible.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

std::vector<Vec2> rounded(std::vector<Vec2> touches, double step_m) {
  for (Vec2& touch : touches) {
    touch = step_m * (touch / step_m).array().round().matrix();
  }
  return touches;
}

/// All around a circle or an ellipse whose half extent is a thousand times the noise.
std::vector<Vec2> touched_all_around(CurveClass truth, int count, double sigma_m,
                                     std::mt19937_64& rng) {
  const double a_m = 1e3 * sigma_m;
  const double b_m = a_m * (truth == CurveClass::Circle ? 1.0 : test::uniform(rng, 0.4, 0.8));
  const Pose2 pose = test::pose_within(rng, 0.5);
  std::vector<Vec2> touches;
  for (const double t : test::angles_around(count, rng)) {
    touches.push_back(pose * Vec2(a_m * std::cos(t), b_m * std::sin(t)) +
                      test::normal_pair(rng, sigma_m));
  }
  return touches;
}

/// From what the rounding adds at random to the residuals, of a step that is the noise over
/// `digits`, log odds of two classes have this standard deviation: half the number of touches times
/// that of log chi-square, which no noise is stated to compare with.
double sigma_of_log_odds(int count, double digits, double noise_over_said) {
  constexpr int kMostUnknowns = 5;  // of an ellipse
  const double of_noise = noise_of_rounding_m(1.0 / digits) * noise_over_said;
  return count * of_noise / std::sqrt(count - kMostUnknowns);
}

double with_log_odds(double probability, double more) {
  const double odds = probability / (1.0 - probability) * std::exp(more);
  return std::isfinite(odds) ? odds / (1.0 + odds) : 1.0;
}

void expect_same_if_rounded(CurveClass truth, int count) {
  constexpr double kStep = 1e-6;  // [m]
  std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(count));
  const RecognizerOptions defaults;
  const int scenes = test::stress_count(15);
  for (const double digits : {10.0, 100.0}) {
    double most = 0.0;
    for (int i = 0; i < scenes; ++i) {
      const double sigma_m = digits * kStep;
      const auto touches = touched_all_around(truth, count, sigma_m, rng);
      const Recognition exact = test::answer_to_touches(touches, 0.0);
      const Recognition answer = test::answer_to_touches(rounded(touches, kStep), 0.0);
      const double p = exact.hypotheses.front().probability;
      const double now = answer.hypotheses.front().probability;
      most = std::max(most, std::abs(now - p));
      const std::string what =
          std::to_string(i) + "\nexact: " + test::said(exact) + "\nrounded: " + test::said(answer);
      EXPECT_EQ(answer.shape.curve_class, exact.shape.curve_class) << what;
      // Five deviations, which none of these scenes has; and a tenth by which an evidence changes
      // where a coordinate comes to be integrated by slices (core/README.md, "In three cases").
      constexpr double kOfSlices = 0.1;
      const double by = 5.0 * sigma_of_log_odds(count, digits, sigma_m / exact.sigma_m) + kOfSlices;
      const double least_p = with_log_odds(p, -by) - kNegligibleProbability;
      const double most_p = with_log_odds(p, by) + kNegligibleProbability;
      EXPECT_GE(now, least_p) << what;
      EXPECT_LE(now, most_p) << what;
      const double needed = defaults.recognized_probability;
      if (least_p >= needed || most_p < needed) {
        EXPECT_EQ(answer.status, exact.status) << what;
      }
    }
    std::cout << name_of(truth) << ", " << count << " touches, step 1 / " << digits
              << " of the noise: probabilities differ by " << most << " at most\n";
  }
}

TEST(RoundedTouches, ToLessThanTheirNoiseAreOfTheSameCircle) {
  for (const int count : {8, 12, 20}) {
    expect_same_if_rounded(CurveClass::Circle, count);
  }
}

TEST(RoundedTouches, ToLessThanTheirNoiseAreOfTheSameEllipse) {
  for (const int count : {12, 20}) {
    expect_same_if_rounded(CurveClass::Ellipse, count);
  }
}

/// Eight touches leave an ellipse three residuals: few tell it, but as many as without rounding.
TEST(RoundedTouches, AsFewAsCanBeRecognisedAreOfAnEllipseNoLessOften) {
  constexpr double kStep = 1e-6;  // [m]
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(300);
  int gained = 0;
  int lost = 0;
  int wrong = 0;
  double stated = 0.0;
  const auto is_right = [](const Recognition& answer) {
    return test::is_recognized(answer) && answer.shape.curve_class == CurveClass::Ellipse;
  };
  for (int i = 0; i < scenes; ++i) {
    const auto touches = touched_all_around(CurveClass::Ellipse, 8, 20.0 * kStep, rng);
    const Recognition answer = test::answer_to_touches(rounded(touches, kStep), 0.0);
    const bool recognized = answer.status == RecognitionStatus::Recognized;
    const bool right_if_exact = is_right(test::answer_to_touches(touches, 0.0));
    gained += is_right(answer) && !right_if_exact ? 1 : 0;
    lost += right_if_exact && !is_right(answer) ? 1 : 0;
    wrong += recognized && !is_right(answer) ? 1 : 0;
    stated += recognized ? test::stated_doubt(answer) : 0.0;
  }
  std::cout << "ellipse, 8 touches: by rounding RECOGNIZED " << gained << " more and " << lost
            << " no more\n";
  EXPECT_LE(wrong, test::most_of_poisson(stated)) << "stated " << stated;
  // So little noise more puts as many over the threshold as under it, like throws of a coin: four
  // deviations of the difference.
  EXPECT_LE(lost - gained, 4.0 * std::sqrt(lost + gained));
}

void expect_noise_of_rounding(CurveClass truth, int count) {
  constexpr double kStep = 5e-5;  // [m]
  std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(count));
  const int scenes = test::stress_count(30);
  int wrong = 0;
  double stated = 0.0;
  for (int i = 0; i < scenes; ++i) {
    const auto touches = touched_all_around(truth, count, kStep / 3.0, rng);
    const Recognition answer = test::answer_to_touches(rounded(touches, kStep), 0.0);
    const bool recognized = test::is_recognized(answer);
    wrong += recognized && answer.shape.curve_class != truth ? 1 : 0;
    stated += recognized ? test::stated_doubt(answer) : 0.0;
    EXPECT_GE(answer.sigma_m, (1.0 - 1e-9) * noise_of_rounding_m(kStep))
        << count << " touches, " << i << ": " << test::said(answer);
  }
  EXPECT_LE(wrong, test::most_of_poisson(stated)) << count << " touches, stated " << stated;
}

TEST(RoundedTouches, ToMoreThanTheirNoiseSayNoLessNoiseThanThatOfACircle) {
  for (const int count : {8, 12, 20}) {
    expect_noise_of_rounding(CurveClass::Circle, count);
  }
}

TEST(RoundedTouches, ToMoreThanTheirNoiseSayNoLessNoiseThanThatOfAnEllipse) {
  for (const int count : {12, 20}) {
    expect_noise_of_rounding(CurveClass::Ellipse, count);
  }
}

}  // namespace
}  // namespace palpate
