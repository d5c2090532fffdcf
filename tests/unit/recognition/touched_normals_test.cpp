// Touches by themselves with measured normals, the class sought: what the normals add.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kDegree = kPi / 180.0;

struct Part {
  Curve curve = Ellipse{0.03, 0.02};
  double from = 0.0;
  double to = 2.0 * kPi;
  double sigma_m = 1e-4;
  double normal_sigma_rad = kDegree;
  Pose2 world_T_curve{0.2, -0.1, 0.4};
};

struct Touch {
  ContactSample sample;
  SampleDetail detail;
};

/// At even parameters, the material left of increasing t.
std::vector<Touch> touch(const Part& part, int count, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<Touch> touches;
  for (int i = 0; i < count; ++i) {
    const double t = part.from + (part.to - part.from) * (i + 0.5) / count;
    const double outward =
        geometry(part.curve, t).tangent_angle + part.world_T_curve.theta - 0.5 * kPi;
    const double x = normal(rng);
    const double y = normal(rng);
    const double measured = outward + part.normal_sigma_rad * normal(rng);
    Touch& touch = touches.emplace_back();
    touch.sample.position_m =
        part.world_T_curve * position(part.curve, t) + part.sigma_m * Vec2(x, y);
    touch.sample.sigma_m = part.sigma_m;
    touch.detail.normal = {std::cos(measured), std::sin(measured)};
    touch.detail.normal_sigma_rad = part.normal_sigma_rad;
  }
  return touches;
}

std::vector<Touch> without_normals(std::vector<Touch> touches) {
  for (Touch& touch : touches) touch.detail = {};
  return touches;
}

Recognition recognise(const std::vector<Touch>& touches, unsigned classes = ~0U) {
  RecognizerOptions options;
  options.classes = classes;
  Recognizer recognizer(options);
  for (std::uint32_t i = 0; i < touches.size(); ++i) {
    recognizer.add({0, i}, {&touches[i].sample, 1}, {&touches[i].detail, 1});
  }
  return recognizer.recognize();
}

Recognition recognise_as(CurveClass curve_class, const std::vector<Touch>& touches) {
  return recognise(touches, 1U << static_cast<unsigned>(curve_class));
}

const Hypothesis& hypothesis_of(const Recognition& answer, CurveClass curve_class) {
  return *std::find_if(answer.hypotheses.begin(), answer.hypotheses.end(),
                       [&](const Hypothesis& h) { return h.shape.curve_class == curve_class; });
}

struct OfClass {
  CurveClass curve_class;
  Part part;
};

std::vector<OfClass> parts_of_all_classes() {
  return {{CurveClass::Line, {Line{}, -0.03, 0.03}},
          {CurveClass::Circle, {Circle{0.025}, 0.3, 2.8}},
          {CurveClass::Ellipse, {Ellipse{0.03, 0.02}, 0.2, 5.8}},
          {CurveClass::Parabola, {Parabola{0.01}, -1.2, 1.6}},
          {CurveClass::Hyperbola, {Hyperbola{0.02, 0.015}, -1.3, 1.6}},
          {CurveClass::CubicalParabola, {CubicalParabola{900.0, 0.2}, -0.025, 0.03}},
          {CurveClass::SemiCubicalParabola, {SemiCubicalParabola{4.0, 0.3}, -0.14, 0.17}},
          {CurveClass::CubicSpline, {CubicSpline{4.0, 0.2, 0.09}, -0.2, 0.2}}};
}

// The fit of a given class has the same likelihood, derived and minimised elsewhere.
TEST(TouchedNormals, ShapeAndCovarianceAreThoseOfTheGivenClass) {
  auto rng = test::test_rng();
  for (const auto& [curve_class, part] : parts_of_all_classes()) {
    const std::vector<Touch> touches = touch(part, 11, rng);
    std::vector<GivenPoint> points;
    for (const Touch& touch : touches) {
      GivenPoint& point = points.emplace_back();
      point.position_m = touch.sample.position_m;
      point.sigma_m = touch.sample.sigma_m;
      point.normal = touch.detail.normal;
      point.normal_sigma_rad = touch.detail.normal_sigma_rad;
    }
    const GivenFit given = fit_given_class(curve_class, points);
    const Recognition answer = recognise_as(curve_class, touches);
    ASSERT_EQ(given.status, GivenStatus::Fitted) << name_of(curve_class);
    const Hypothesis& found = hypothesis_of(answer, curve_class);
    ASSERT_FALSE(found.at_limit) << name_of(curve_class);
    EXPECT_EQ(found.dof, given.dof) << name_of(curve_class);
    // Chi-square within what a fit's tolerance leaves; shapes within a hundredth of a deviation.
    EXPECT_NEAR(found.chi2, given.chi2, 1e-2) << name_of(curve_class);
    for (Eigen::Index k = 0; k < 3 && k + 3 < given.covariance.rows(); ++k) {
      const double deviation = std::sqrt(given.covariance(k, k));
      EXPECT_NEAR(found.shape.values[k], given.shape.values[k], 0.02 * deviation)
          << name_of(curve_class) << " " << k;
      const bool is_valley = answer.covariance.isApprox(found.covariance, 1e-9) &&
                             !answer.covariance.isApprox(given.covariance, 1e-2);
      if (!is_valley) {
        EXPECT_NEAR(std::sqrt(found.covariance(k, k)) / deviation, 1.0, 0.02)
            << name_of(curve_class) << " " << k;
      }
    }
  }
}

TEST(TouchedNormals, ErrorsHaveTheLawOfTheirCovariance) {
  auto rng = test::test_rng();
  constexpr int kScenes = 300;
  Part part;
  part.sigma_m = 3e-4;
  double squares = 0.0;
  double narrower = 0.0;
  for (int scene = 0; scene < kScenes; ++scene) {
    const std::vector<Touch> touches = touch(part, 9, rng);
    const Recognition with_normals = recognise_as(CurveClass::Ellipse, touches);
    const Recognition without = recognise_as(CurveClass::Ellipse, without_normals(touches));
    // (Once in a thousand scenes the residuals are so large that "unclassified" is more probable.)
    const Hypothesis& answer = hypothesis_of(with_normals, CurveClass::Ellipse);
    const Hypothesis& plain = hypothesis_of(without, CurveClass::Ellipse);
    ASSERT_EQ(answer.covariance.rows(), 5);
    ASSERT_EQ(plain.covariance.rows(), 5);
    const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
    const Eigen::Vector2d error = answer.shape.values.head<2>() - Eigen::Vector2d(0.03, 0.02);
    squares += error.dot(covariance.inverse() * error);
    narrower += 0.5 * std::log(plain.covariance.topLeftCorner<2, 2>().determinant() /
                               covariance.determinant());
  }
  // Chi-square of 2 a scene: mean 2, variance 4; five deviations of the mean. The quadratic term of
  // errors of a hundredth of the part adds a hundredth.
  EXPECT_NEAR(squares / kScenes, 2.0, 5.0 * std::sqrt(4.0 / kScenes) + 0.02);
  EXPECT_GT(narrower / kScenes, 0.0);
}

TEST(TouchedNormals, FewerTouchesTellTheClass) {
  auto rng = test::test_rng();
  int with = 0;
  int without = 0;
  for (int scene = 0; scene < 40; ++scene) {
    Part part;
    part.sigma_m = 5e-5;
    part.from = 0.3;
    part.to = 2.9;
    const std::vector<Touch> touches = touch(part, 8, rng);
    const auto is_right = [](const Recognition& answer) {
      return answer.shape.curve_class == CurveClass::Ellipse &&
                     answer.hypotheses.front().probability > 0.95
                 ? 1
                 : 0;
    };
    with += is_right(recognise(touches));
    without += is_right(recognise(without_normals(touches)));
  }
  RecordProperty("with", with);
  RecordProperty("without", without);
  std::printf("ellipse on 150 degrees, 8 touches, noise 50 um: %d of 40 with normals, %d without\n",
              with, without);
  EXPECT_GT(with, without);
}

TEST(TouchedNormals, MotionScaleAndOrderChangeNothing) {
  auto rng = test::test_rng();
  const std::vector<Touch> touches = touch({}, 12, rng);
  const Recognition answer = recognise(touches);
  ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
  const double sd = std::sqrt(answer.covariance(0, 0));
  const Pose2 motion{-3.0, 7.0, 2.1};
  std::vector<Touch> moved = touches;
  std::vector<Touch> scaled = touches;
  for (Touch& touch : moved) {
    touch.sample.position_m = motion * touch.sample.position_m;
    touch.detail.normal = motion.rotate(touch.detail.normal);
  }
  for (Touch& touch : scaled) {
    touch.sample.position_m *= 1e3;
    touch.sample.sigma_m *= 1e3;
  }
  std::vector<Touch> reversed(touches.rbegin(), touches.rend());
  std::vector<Touch> inside = touches;  // a surface without a tip has its normal either way round
  for (Touch& touch : inside) touch.detail.normal *= -1.0;
  for (const auto& [other, unit] :
       {std::pair(recognise(moved), 1.0), std::pair(recognise(scaled), 1e3),
        std::pair(recognise(reversed), 1.0), std::pair(recognise(inside), 1.0)}) {
    ASSERT_EQ(other.shape.curve_class, CurveClass::Ellipse);
    EXPECT_EQ(other.status, answer.status);
    // As far as the fits' tolerance goes, of chi-square 1e-6: a thousandth of a deviation.
    EXPECT_NEAR(other.shape.values[0] / unit, answer.shape.values[0], 2e-3 * sd);
    EXPECT_NEAR(other.hypotheses.front().chi2, answer.hypotheses.front().chi2, 1e-3);
    EXPECT_NEAR(other.hypotheses.front().probability, answer.hypotheses.front().probability, 1e-2);
  }
}

void expect_same(const Recognition& a, const Recognition& b) {
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  EXPECT_EQ(a.status, b.status);
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].shape.curve_class, b.hypotheses[i].shape.curve_class);
    EXPECT_EQ(a.hypotheses[i].shape.values, b.hypotheses[i].shape.values);
    EXPECT_EQ(a.hypotheses[i].probability, b.hypotheses[i].probability);
    EXPECT_EQ(a.hypotheses[i].chi2, b.hypotheses[i].chi2);
    EXPECT_EQ(a.hypotheses[i].covariance, b.hypotheses[i].covariance);
  }
}

TEST(TouchedNormals, WhereTheyDoNotCountTheAnswerIsTheSameToTheBit) {
  auto rng = test::test_rng();
  std::vector<Touch> touches = touch({}, 12, rng);
  for (Touch& touch : touches) touch.sample.sigma_m = 0.0;
  const Recognition of_unknown_noise = recognise(touches);
  EXPECT_EQ(of_unknown_noise.simplified_count, 12U);
  expect_same(of_unknown_noise, recognise(without_normals(touches)));
}

TEST(TouchedNormals, WhatCountsInFullIsNotSimplified) {
  auto rng = test::test_rng();
  std::vector<Touch> touches = touch({}, 12, rng);
  EXPECT_EQ(recognise(touches).simplified_count, 0U);
  touches[3].detail.covariance_m2 = {1e-8, 0.0, 2e-8};
  touches[3].sample.sigma_m = mean_sigma_m(touches[3].detail.covariance_m2);
  EXPECT_EQ(recognise(touches).simplified_count, 0U);
}

TEST(TouchedNormals, OneThatIsWronglyMeasuredIsSetAside) {
  auto rng = test::test_rng();
  std::vector<Touch> touches = touch({}, 16, rng);
  touches[5].detail.normal = Eigen::Rotation2Dd(0.5) * touches[5].detail.normal;
  const Recognition answer = recognise(touches);
  EXPECT_EQ(answer.status, RecognitionStatus::Recognized);
  EXPECT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
  EXPECT_EQ(answer.outlier_count, 1U);
}

// The points lie on the curve; what the normals are of is another.
TEST(TouchedNormals, NormalsOfAnotherCurveAreAMisfit) {
  auto rng = test::test_rng();
  std::vector<Touch> touches = touch({}, 16, rng);
  ASSERT_EQ(recognise(touches).status, RecognitionStatus::Recognized);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    // Ten deviations either way.
    touches[i].detail.normal = Eigen::Rotation2Dd(i % 2 == 0 ? 10.0 * kDegree : -10.0 * kDegree) *
                               touches[i].detail.normal;
  }
  const Recognition answer = recognise(touches);
  EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
               answer.shape.curve_class != CurveClass::Unclassified);
}

}  // namespace
}  // namespace palpate
