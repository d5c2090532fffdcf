// Measured normals and covariances in the search for a class: the side of a round tip, and nothing
// where they say nothing.
#include "core/recognition/samples/sample_detail.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigmaM = 1e-5;

/// Strokes or touches of a round tip on a circle of which nobody states the side.
struct Bore {
  double surface_radius_m = 0.030;
  double tip_radius_m = 0.003;
  bool inside = true;  ///< the tip is within: a bore; else a boss
  double normal_sigma_rad = 0.05;
  Pose2 motion;
};

struct Touched {
  std::vector<ContactSample> samples;
  std::vector<SampleDetail> details;
};

Touched stroke(const Bore& bore, double from, double to, int count, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  Touched touched;
  const double out = bore.inside ? -1.0 : 1.0;  // along the radius, out of the material
  for (int i = 0; i < count; ++i) {
    const double angle = from + (to - from) * i / std::max(count - 1, 1);
    const Vec2 radial(std::cos(angle), std::sin(angle));
    const double path_m = bore.surface_radius_m + out * bore.tip_radius_m;
    const Vec2 noise = kSigmaM * Vec2(normal(rng), normal(rng));
    touched.samples.push_back({bore.motion * (path_m * radial + noise), kSigmaM, 0});
    SampleDetail& detail = touched.details.emplace_back();
    const double off = bore.normal_sigma_rad * normal(rng);
    detail.normal = as_unit(bore.motion.rotate(Eigen::Rotation2Dd(off) * (out * radial)));
    detail.normal_sigma_rad = bore.normal_sigma_rad;
  }
  return touched;
}

/// Two strokes with another direction of travel each.
Recognition recognise_strokes(const Bore& bore, bool with_normals) {
  auto rng = test::test_rng();
  Recognizer recognizer;
  for (std::uint32_t patch = 0; patch < 2; ++patch) {
    const double from = patch == 0 ? 0.0 : 4.5;
    const Touched touched = stroke(bore, from, patch == 0 ? 1.5 : 3.0, 120, rng);
    const PatchContext context{0, patch, bore.tip_radius_m};
    recognizer.add(context, touched.samples,
                   with_normals ? std::span<const SampleDetail>(touched.details)
                                : std::span<const SampleDetail>());
  }
  return recognizer.recognize();
}

Recognition recognise_touches(const Bore& bore, int count, bool with_normals) {
  auto rng = test::test_rng();
  Recognizer recognizer;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * i / count;
    const Touched touched = stroke(bore, angle, angle, 1, rng);
    const PatchContext context{0, static_cast<std::uint32_t>(i), bore.tip_radius_m};
    recognizer.add(context, touched.samples,
                   with_normals ? std::span<const SampleDetail>(touched.details)
                                : std::span<const SampleDetail>());
  }
  return recognizer.recognize();
}

TEST(MeasuredNormals, TellBoreFromBoss) {
  for (const bool inside : {true, false}) {
    Bore bore;
    bore.inside = inside;
    const Recognition answer = recognise_strokes(bore, true);
    ASSERT_EQ(answer.shape.curve_class, CurveClass::Circle);
    EXPECT_EQ(answer.status, RecognitionStatus::Recognized) << name_of(answer.doubt);
    const double deviation = std::sqrt(answer.covariance(0, 0));
    EXPECT_NEAR(answer.shape.values[0], bore.surface_radius_m, 5.0 * deviation);
    EXPECT_EQ(answer.simplified_count, 0U);
  }
  // Where nobody tells the side, the same strokes are of a boss: probes come from outside.
  const Recognition blind = recognise_strokes({}, false);
  EXPECT_GT(std::abs(blind.shape.values[0] - Bore{}.surface_radius_m), Bore{}.tip_radius_m);
}

TEST(MeasuredNormals, TellTheSideOfTouches) {
  for (const int count : {8, 12, 60}) {
    for (const bool inside : {true, false}) {
      Bore bore;
      bore.inside = inside;
      const Recognition answer = recognise_touches(bore, count, true);
      ASSERT_EQ(answer.shape.curve_class, CurveClass::Circle) << count;
      EXPECT_EQ(answer.status, RecognitionStatus::Recognized)
          << count << " " << name_of(answer.doubt);
      const double deviation = std::sqrt(answer.covariance(0, 0));
      EXPECT_NEAR(answer.shape.values[0], bore.surface_radius_m, 5.0 * deviation) << count;
    }
    const Recognition blind = recognise_touches({}, count, false);
    EXPECT_GT(std::abs(blind.shape.values[0] - Bore{}.surface_radius_m), Bore{}.tip_radius_m);
  }
}

TEST(MeasuredNormals, AreBelievedAgainstAStatedSide) {
  auto rng = test::test_rng();
  const Bore bore;
  Recognizer recognizer;
  for (std::uint32_t patch = 0; patch < 2; ++patch) {
    const Touched touched = stroke(bore, 2.0 * patch, 2.0 * patch + 1.5, 120, rng);
    // Against the clock, material on the left: that is a boss.
    recognizer.add({0, patch, bore.tip_radius_m, MaterialSide::Left}, touched.samples,
                   touched.details);
  }
  EXPECT_NEAR(recognizer.recognize().shape.values[0], bore.surface_radius_m, 1e-4);
}

TEST(MeasuredNormals, OfNoPrecisionTellNothing) {
  Bore bore;
  bore.normal_sigma_rad = 3.0;
  const Recognition with = recognise_touches(bore, 12, true);
  const Recognition without = recognise_touches(bore, 12, false);
  EXPECT_EQ(with.shape.values, without.shape.values);
  EXPECT_EQ(with.status, without.status);
}

TEST(MeasuredNormals, OfAnyPrecisionTellTheSide) {
  for (const double sigma_rad : {1e-300, 1e-12, 1e-3, 0.3}) {
    Bore bore;
    bore.normal_sigma_rad = sigma_rad;
    EXPECT_NEAR(recognise_strokes(bore, true).shape.values[0], bore.surface_radius_m, 1e-4)
        << sigma_rad;
  }
}

TEST(MeasuredNormals, AnAnswerMovesWithThem) {
  Bore bore;
  const Recognition answer = recognise_strokes(bore, true);
  for (const double theta : {0.7, 2.2, -2.9}) {
    bore.motion = {3.0, -2.0, theta};
    const Recognition moved = recognise_strokes(bore, true);
    EXPECT_EQ(moved.status, answer.status);
    const double deviation = std::sqrt(answer.covariance(0, 0));
    EXPECT_NEAR(moved.shape.values[0], answer.shape.values[0], 1e-3 * deviation);
    const Vec2 centre = bore.motion * answer.world_T_curve.translation();
    EXPECT_LT((moved.world_T_curve.translation() - centre).norm(), 1e-3 * deviation);
  }
}

/// All numbers of an answer that a planner reads first.
std::vector<double> numbers_of(const Recognition& answer) {
  std::vector<double> numbers = {answer.world_T_curve.x, answer.world_T_curve.y,
                                 answer.world_T_curve.theta, answer.sigma_m,
                                 answer.noise_correlation_m};
  numbers.insert(numbers.end(), answer.shape.values.begin(), answer.shape.values.end());
  for (Eigen::Index i = 0; i < answer.covariance.size(); ++i) {
    numbers.push_back(answer.covariance.data()[i]);
  }
  for (const Hypothesis& hypothesis : answer.hypotheses) {
    numbers.push_back(hypothesis.probability);
    numbers.push_back(hypothesis.chi2);
  }
  for (const LocalizedContact& contact : answer.contacts) {
    numbers.push_back(contact.estimate.kappa);
    numbers.push_back(contact.t);
  }
  return numbers;
}

TEST(MeasuredNormals, WhereTheySayNothingTheAnswerIsTheSameToTheLastBit) {
  Bore surface;
  surface.tip_radius_m = 0.0;
  surface.normal_sigma_rad = 3.0;
  // Of points of the surface a normal tells no side, and one that may be anywhere no direction; a
  // detail that is empty tells nothing at all.
  const Recognition without = recognise_strokes(surface, false);
  EXPECT_EQ(numbers_of(recognise_strokes(surface, true)), numbers_of(without));
  auto rng = test::test_rng();
  Recognizer plain;
  Recognizer empty;
  const Bore bore;
  for (std::uint32_t patch = 0; patch < 2; ++patch) {
    const Touched touched = stroke(bore, 2.0 * patch, 2.0 * patch + 1.5, 120, rng);
    const PatchContext context{0, patch, bore.tip_radius_m};
    plain.add(context, touched.samples);
    const std::vector<SampleDetail> nothing(touched.samples.size());
    EXPECT_EQ(empty.add(context, touched.samples, nothing).detailed, 0U);
  }
  const Recognition answer = empty.recognize();
  EXPECT_EQ(numbers_of(plain.recognize()), numbers_of(answer));
  EXPECT_EQ(answer.simplified_count, 0U);
}

}  // namespace
}  // namespace palpate
