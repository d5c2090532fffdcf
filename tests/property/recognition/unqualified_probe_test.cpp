// Parts touched by probes of which half deviate by the law of core/README.md, "Deviations that
// neighbours share": stated classes and shapes must be as reliable as stated.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/ellipse.h"
#include "core/numerics/probability/chi_square.h"
#include "core/recognition/recognizer.h"
#include "tests/support/calibration.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::log_uniform;
using test::uniform;

constexpr int kSamples = 160;
constexpr double kCoverage = 0.999;

struct Touched {
  Ellipse part{1.0, 1.0};  ///< a circle if the axes are equal
  std::vector<ContactSample> samples;
};

/// The probe's offset by the direction of the normal, and its drift along the stroke.
std::vector<double> deviations(const std::vector<double>& normal_angle,
                               const std::vector<double>& along, double sigma,
                               std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const double most = std::sqrt(static_cast<double>(kSamples));
  const double deviation = sigma * log_uniform(rng, 1.0 / most, most);
  const double length = std::ldexp(along.back(), -std::uniform_int_distribution<int>(1, 5)(rng));
  std::vector<double> result;
  double drift = deviation * normal(rng);
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double kept = i > 0 ? std::exp(-(along[i] - along[i - 1]) / length) : 1.0;
    drift = kept * drift + std::sqrt(1.0 - kept * kept) * deviation * normal(rng);
    result.push_back(drift);
  }
  const double order = std::round(std::clamp(1.0 / length, 2.0, 8.0));
  const double size =
      std::abs(std::student_t_distribution<double>(3.0)(rng)) * deviation * order * order / 4.0;
  const int highest = std::uniform_int_distribution<int>(1, 8)(rng);  // 1: only the constant
  const double constant = size * normal(rng);
  for (double& value : result) {
    value += constant;
  }
  for (int k = 2; k <= highest; ++k) {
    const double cosine = size * 4.0 / (k * k) * normal(rng);
    const double sine = size * 4.0 / (k * k) * normal(rng);
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] += cosine * std::cos(k * normal_angle[i]) + sine * std::sin(k * normal_angle[i]);
    }
  }
  return result;
}

Touched touched(const Ellipse& part, double sigma, bool deviates, std::mt19937_64& rng) {
  const double begin = uniform(rng, 0.0, 6.0);
  const double arc = uniform(rng, 2.0, 6.2);
  std::vector<double> t, normal_angle, along;
  for (int i = 0; i < kSamples; ++i) {
    t.push_back(begin + arc * i / (kSamples - 1));
    const Vec2 outward(part.b * std::cos(t.back()), part.a * std::sin(t.back()));
    normal_angle.push_back(std::atan2(outward.y(), outward.x()));
    along.push_back(
        i == 0 ? 0.0
               : along.back() +
                     (part.position(t[t.size() - 1]) - part.position(t[t.size() - 2])).norm());
  }
  // A probe that is off by more than a hundredth of the part is not suitable for it.
  constexpr double kMostOff = 0.01;
  std::vector<double> off(kSamples, 0.0);
  if (deviates) {
    do {
      off = deviations(normal_angle, along, sigma, rng);
    } while (std::any_of(off.begin(), off.end(),
                         [](double value) { return std::abs(value) > kMostOff; }));
  }
  std::normal_distribution<double> noise(0.0, sigma);
  Touched result{part, {}};
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double radial = off[i] + noise(rng);
    ContactSample sample;
    sample.position_m =
        part.position(t[i]) + radial * Vec2(std::cos(normal_angle[i]), std::sin(normal_angle[i]));
    result.samples.push_back(sample);
  }
  return result;
}

Recognition recognise(const Touched& scene, bool unqualified, unsigned classes = ~0U) {
  RecognizerOptions options;
  options.unqualified_probe = unqualified;
  options.classes = classes;
  Recognizer recognizer(options);
  recognizer.add({}, scene.samples);
  return recognizer.recognize();
}

unsigned bit(CurveClass curve_class) { return 1U << static_cast<unsigned>(curve_class); }

/// As in the prior: half of the parts are circles; m = e^2 - 1 of the others is uniform.
Ellipse part_of_prior(std::mt19937_64& rng) {
  const bool circle = uniform(rng, 0.0, 1.0) < 0.5;
  return {1.0, circle ? 1.0 : std::sqrt(uniform(rng, 0.0, 1.0))};
}

TEST(UnqualifiedProbe, ProbabilitiesAreTrue) {
  constexpr double kSure = 0.95;
  std::mt19937_64 rng = test::test_rng();
  std::vector<double> stated;
  int right = 0;
  const int scenes = test::stress_count(1200);
  const unsigned classes = bit(CurveClass::Circle) | bit(CurveClass::Ellipse);
  for (int i = 0; i < scenes; ++i) {
    const Ellipse part = part_of_prior(rng);
    const double sigma = log_uniform(rng, 1e-4, 1e-2);
    const Touched scene = touched(part, sigma, uniform(rng, 0.0, 1.0) < 0.5, rng);
    const Recognition answer = recognise(scene, true, classes);
    ASSERT_FALSE(answer.hypotheses.empty());
    const double probability = answer.hypotheses.front().probability;
    const CurveClass truth = part.a == part.b ? CurveClass::Circle : CurveClass::Ellipse;
    if (probability >= kSure) {
      stated.push_back(probability);
      right += answer.shape.curve_class == truth ? 1 : 0;
    }
  }
  const test::Band band = test::binomial_band(stated, kCoverage);
  std::cout << "sure " << stated.size() << " of " << scenes << ", right " << right << ", band "
            << band.least << " to " << band.most << "\n";
  EXPECT_GE(right, band.least);
  EXPECT_GT(static_cast<int>(stated.size()), scenes / 2);  // otherwise the test says little
}

TEST(UnqualifiedProbe, MakesNoEllipseOfARing) {
  std::mt19937_64 rng = test::test_rng();
  const RecognizerOptions options;
  std::vector<double> asked;
  int wrong = 0;
  const int scenes = test::stress_count(400);
  for (int i = 0; i < scenes; ++i) {
    const Touched scene = touched({1.0, 1.0}, log_uniform(rng, 1e-4, 1e-2), true, rng);
    const Recognition answer = recognise(scene, true);
    if (answer.status == RecognitionStatus::Recognized) {
      asked.push_back(1.0 - options.recognized_probability);
      wrong += answer.shape.curve_class != CurveClass::Circle ? 1 : 0;
    }
  }
  std::cout << "RECOGNIZED " << asked.size() << " of " << scenes << ", " << wrong
            << " as no circle\n";
  EXPECT_LE(wrong, test::binomial_band(asked, kCoverage).most);
  EXPECT_GT(asked.size(), static_cast<std::size_t>(scenes / 4));  // otherwise the test says little
}

/// A full turn around a ring by a probe with two lobes; `chi2` is what a circle leaves of them.
Touched ring_by_two_lobes(double chi2, std::mt19937_64& rng) {
  const double sigma = 3e-3;
  const double lobe = sigma * std::sqrt(2.0 * chi2 / kSamples);
  const double axis = uniform(rng, 0.0, 2.0 * kPi);
  std::normal_distribution<double> noise(0.0, sigma);
  Touched ring;
  for (int i = 0; i < kSamples; ++i) {
    const double t = 2.0 * kPi * i / kSamples;
    ContactSample sample;
    sample.position_m =
        (1.0 + lobe * std::cos(2.0 * t - axis) + noise(rng)) * Vec2(std::cos(t), std::sin(t));
    ring.samples.push_back(sample);
  }
  return ring;
}

/// These lobes are not visible in the residuals.
TEST(UnqualifiedProbe, WithHiddenLobesMakesNoSureEllipse) {
  std::mt19937_64 rng = test::test_rng();
  const RecognizerOptions options;
  for (const double chi2 : {10.0, 30.0, 100.0}) {
    std::vector<double> asked;
    int ellipses = 0;
    const int scenes = test::stress_count(100);
    for (int i = 0; i < scenes; ++i) {
      const Recognition answer = recognise(ring_by_two_lobes(chi2, rng), true);
      asked.push_back(1.0 - options.recognized_probability);
      ellipses += answer.status == RecognitionStatus::Recognized &&
                          answer.shape.curve_class == CurveClass::Ellipse
                      ? 1
                      : 0;
    }
    EXPECT_LE(ellipses, test::binomial_band(asked, kCoverage).most) << "chi-square " << chi2;
  }
}

/// A part that no such deviation explains is as certain as without the option.
TEST(UnqualifiedProbe, LeavesPlainEllipsesRecognized) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(40);
  for (int i = 0; i < scenes; ++i) {
    const Touched scene =
        touched({1.0, uniform(rng, 0.3, 0.8)}, log_uniform(rng, 1e-4, 1e-3), false, rng);
    const Recognition exact = recognise(scene, false);
    if (exact.status == RecognitionStatus::Recognized) {
      const Recognition answer = recognise(scene, true);
      EXPECT_EQ(answer.shape.curve_class, exact.shape.curve_class);
      EXPECT_GE(answer.hypotheses.front().probability, 0.95) << scene.part.b;
    }
  }
}

/// Whoever does not state the noise has not measured the probe; whoever states it has, unless he
/// says otherwise.
TEST(UnqualifiedProbe, IsOneWhoseNoiseIsNotStated) {
  std::mt19937_64 rng = test::test_rng();
  Touched scene = touched({1.0, 0.7}, 1e-3, false, rng);
  const auto answer_to = [&](std::optional<bool> unqualified) {
    RecognizerOptions options;
    options.unqualified_probe = unqualified;
    Recognizer recognizer(options);
    recognizer.add({}, scene.samples);
    return recognizer.recognize();
  };
  EXPECT_TRUE(answer_to(std::nullopt).unqualified_probe);
  EXPECT_EQ(answer_to(std::nullopt).covariance, answer_to(true).covariance);
  EXPECT_FALSE(answer_to(false).unqualified_probe);
  EXPECT_LT(answer_to(false).covariance(0, 0), answer_to(true).covariance(0, 0));
  for (ContactSample& sample : scene.samples) sample.sigma_m = 1e-3;
  EXPECT_FALSE(answer_to(std::nullopt).unqualified_probe);
  EXPECT_EQ(answer_to(std::nullopt).covariance, answer_to(false).covariance);
  EXPECT_TRUE(answer_to(true).unqualified_probe);
  scene.samples.front().sigma_m = 0.0;  // one is enough: the noise of all is then estimated
  EXPECT_TRUE(answer_to(std::nullopt).unqualified_probe);
}

TEST(UnqualifiedProbe, RegionsHoldTheShape) {
  std::mt19937_64 rng = test::test_rng();
  // The moment is that of a mixture with long tails. The 95 % region of a normal distribution with
  // the same moment contains at least 90 % of it (as required of answers without a probe file).
  constexpr double kHeld = 0.9;
  std::vector<double> asked;
  int held = 0;
  const int scenes = test::stress_count(300);
  for (int i = 0; i < scenes; ++i) {
    const Touched scene = touched({1.0, 0.7}, log_uniform(rng, 1e-4, 3e-3), true, rng);
    const Recognition answer = recognise(scene, true);
    if (answer.shape.curve_class != CurveClass::Ellipse || answer.covariance.size() == 0) {
      continue;
    }
    const Eigen::Vector2d off = answer.shape.values.head<2>() - Eigen::Vector2d(1.0, 0.7);
    const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
    asked.push_back(kHeld);
    held += off.dot(covariance.inverse() * off) <= chi_square_threshold(0.05, 2) ? 1 : 0;
  }
  std::cout << "95 % regions hold " << held << " of " << asked.size() << "\n";
  EXPECT_GE(held, test::binomial_band(asked, kCoverage).least);
}

}  // namespace
}  // namespace palpate
