// Strokes whose samples bring normals and noise that is longer one way, the class sought: all of it
// counts.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/numerics/probability/chi_square.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kDegree = kPi / 180.0;

/// A part and how it is stroked.
struct Stroked {
  Curve curve = Ellipse{0.03, 0.02};
  std::vector<Eigen::Vector2d> arcs = {{0.2, 2.2}, {3.0, 5.0}};  ///< from, to; a patch each
  int samples = 60;                                              ///< of a patch
  double sigma_m = 1e-4;  ///< along the noise's short axis where it has a long one
  double longer = 1.0;    ///< the long axis over the short one; 1 = no covariance is told
  double long_axis_rad = 0.7;
  double normal_sigma_rad = 0.0;  ///< 0 = no normals
  Pose2 world_T_curve{0.2, -0.1, 0.4};
};

struct Stroke {
  std::vector<ContactSample> samples;
  std::vector<SampleDetail> details;
};

std::vector<Stroke> stroke(const Stroked& part, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const Eigen::Matrix2d axes = Eigen::Rotation2Dd(part.long_axis_rad).toRotationMatrix();
  const Vec2 lengths = part.sigma_m * Vec2(part.longer, 1.0);
  const Eigen::Matrix2d covariance = axes * lengths.cwiseAbs2().asDiagonal() * axes.transpose();
  std::vector<Stroke> strokes;
  for (const Eigen::Vector2d& arc : part.arcs) {
    Stroke& patch = strokes.emplace_back();
    for (int i = 0; i < part.samples; ++i) {
      const double t = arc[0] + (arc[1] - arc[0]) * i / (part.samples - 1.0);
      const double x = normal(rng);
      const double y = normal(rng);
      ContactSample& sample = patch.samples.emplace_back();
      sample.position_m =
          part.world_T_curve * position(part.curve, t) + axes * lengths.cwiseProduct(Vec2(x, y));
      sample.sigma_m = part.sigma_m;
      SampleDetail& detail = patch.details.emplace_back();
      if (part.longer != 1.0) {
        detail.covariance_m2 = {covariance(0, 0), covariance(0, 1), covariance(1, 1)};
        sample.sigma_m = mean_sigma_m(detail.covariance_m2);
      }
      if (part.normal_sigma_rad > 0.0) {
        const double outward =
            geometry(part.curve, t).tangent_angle + part.world_T_curve.theta - 0.5 * kPi;
        const double measured = outward + part.normal_sigma_rad * normal(rng);
        detail.normal = {std::cos(measured), std::sin(measured)};
        detail.normal_sigma_rad = part.normal_sigma_rad;
      }
    }
  }
  return strokes;
}

std::vector<Stroke> without_details(std::vector<Stroke> strokes) {
  for (Stroke& patch : strokes) patch.details.clear();
  return strokes;
}

Recognition recognise(const std::vector<Stroke>& strokes, RecognizerOptions options = {}) {
  Recognizer recognizer(options);
  for (std::uint32_t p = 0; p < strokes.size(); ++p) {
    recognizer.add({0, p}, strokes[p].samples, strokes[p].details);
  }
  return recognizer.recognize();
}

Recognition recognise_as(CurveClass curve_class, const std::vector<Stroke>& strokes) {
  RecognizerOptions options;
  options.classes = 1U << static_cast<unsigned>(curve_class);
  return recognise(strokes, options);
}

const Hypothesis& hypothesis_of(const Recognition& answer, CurveClass curve_class) {
  return *std::find_if(answer.hypotheses.begin(), answer.hypotheses.end(),
                       [&](const Hypothesis& h) { return h.shape.curve_class == curve_class; });
}

GivenFit given(CurveClass curve_class, const std::vector<Stroke>& strokes) {
  std::vector<GivenPoint> points;
  for (const Stroke& patch : strokes) {
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
      GivenPoint& point = points.emplace_back();
      point.position_m = patch.samples[i].position_m;
      point.sigma_m = patch.samples[i].sigma_m;
      point.normal = patch.details[i].normal;
      point.normal_sigma_rad = patch.details[i].normal_sigma_rad;
      point.covariance_m2 = patch.details[i].covariance_m2;
    }
  }
  return fit_given_class(curve_class, points);
}

std::vector<Stroked> parts_of_all_classes() {
  return {{Line{}, {{-0.03, -0.01}, {0.01, 0.03}}},
          {Circle{0.025}, {{0.3, 1.4}, {1.9, 2.8}}},
          {Ellipse{0.03, 0.02}, {{0.2, 2.2}, {3.0, 5.0}}},
          {Parabola{0.01}, {{-1.2, 0.3}, {0.6, 1.6}}},
          {Hyperbola{0.02, 0.015}, {{-1.3, 0.2}, {0.5, 1.6}}},
          {CubicalParabola{900.0, 0.2}, {{-0.025, 0.0}, {0.005, 0.03}}},
          {SemiCubicalParabola{4.0, 0.3}, {{-0.17, -0.06}, {0.06, 0.17}}},
          {CubicSpline{4.0, 0.2, 0.09}, {{-0.2, -0.02}, {0.03, 0.2}}}};
}

/// What is told of the samples.
struct Told {
  double longer;
  double normal_sigma_rad;
};
constexpr Told kAllTold[] = {{10.0, 0.0}, {1.0, kDegree}, {10.0, kDegree}};

// The fit of a given class has the same likelihood, derived and minimised elsewhere.
TEST(StrokesInFull, ShapeAndCovarianceAreThoseOfTheGivenClass) {
  auto rng = test::test_rng();
  for (const Told& told : kAllTold) {
    for (Stroked part : parts_of_all_classes()) {
      part.longer = told.longer;
      part.normal_sigma_rad = told.normal_sigma_rad;
      part.sigma_m = 1e-5;
      const CurveClass curve_class = class_of(part.curve);
      const std::vector<Stroke> strokes = stroke(part, rng);
      const GivenFit expected = given(curve_class, strokes);
      const Recognition answer = recognise_as(curve_class, strokes);
      const auto context = [&] {
        return std::string(name_of(curve_class)) + (told.longer > 1.0 ? ", covariances" : "") +
               (told.normal_sigma_rad > 0.0 ? ", normals" : "");
      };
      ASSERT_EQ(expected.status, GivenStatus::Fitted) << context();
      ASSERT_EQ(answer.outlier_count, 0U) << context();
      EXPECT_EQ(answer.simplified_count, 0U) << context();
      const Hypothesis& found = hypothesis_of(answer, curve_class);
      ASSERT_FALSE(found.at_limit) << context();
      EXPECT_EQ(found.dof, expected.dof) << context();
      // Within what a fit's tolerance leaves. And there the residual of an angle e is 2 tan(e / 2),
      // here e: squares differ by e^4 / (6 s^2), half of s^2 a normal in the mean.
      const double by_tangent = 2.0 * 0.5 * 120 * told.normal_sigma_rad * told.normal_sigma_rad;
      EXPECT_NEAR(found.chi2, expected.chi2, 1e-2 + by_tangent) << context();
      for (Eigen::Index k = 0; k < expected.covariance.rows(); ++k) {
        const double deviation = std::sqrt(expected.covariance(k, k));
        if (k < 3 && k + 3 < expected.covariance.rows()) {
          EXPECT_NEAR(found.shape.values[k], expected.shape.values[k], 0.02 * deviation)
              << context() << " " << k;
        }
        if (curve_class != CurveClass::Line) {  // how far along it the origin lies is a convention
          // A valley that bends has more than the bound.
          EXPECT_GE(std::sqrt(found.covariance(k, k)), 0.98 * deviation) << context() << " " << k;
          EXPECT_LE(std::sqrt(found.covariance(k, k)), 1.1 * deviation) << context() << " " << k;
        }
      }
    }
  }
}

// No path tells their direction: the class does, once it is known.
TEST(StrokesInFull, TouchesAloneAreWeighedAcrossTheCurve) {
  auto rng = test::test_rng();
  for (const int count : {9, 14}) {
    Stroked part;
    part.arcs = {{0.1, 5.7}};
    part.samples = count;
    part.longer = 10.0;
    part.sigma_m = 1e-5;
    const std::vector<Stroke> touched = stroke(part, rng);
    std::vector<Stroke> touches;
    for (std::size_t i = 0; i < touched[0].samples.size(); ++i) {
      touches.push_back({{touched[0].samples[i]}, {touched[0].details[i]}});
    }
    const GivenFit expected = given(CurveClass::Ellipse, touches);
    const Recognition answer = recognise(touches);
    ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse) << count;
    EXPECT_EQ(answer.simplified_count, 0U);
    EXPECT_EQ(answer.outlier_count, 0U);
    EXPECT_NEAR(answer.hypotheses.front().chi2, expected.chi2, 1e-2);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double deviation = std::sqrt(expected.covariance(k, k));
      EXPECT_NEAR(answer.shape.values[k], expected.shape.values[k], 0.02 * deviation);
      EXPECT_GE(std::sqrt(answer.covariance(k, k)), 0.98 * deviation);
      EXPECT_LE(std::sqrt(answer.covariance(k, k)), 1.1 * deviation);
    }
  }
}

// The covariance is the bound with what is told, so that this says how near the errors come to it.
TEST(StrokesInFull, ErrorsHaveTheLawOfTheirCovariance) {
  auto rng = test::test_rng();
  constexpr int kScenes = 300;
  for (const Told& told : kAllTold) {
    Stroked part;
    part.longer = told.longer;
    part.normal_sigma_rad = told.normal_sigma_rad;
    part.sigma_m = told.longer > 1.0 ? 1e-5 : 2e-4;
    double squares = 0.0;
    int beyond = 0;
    double narrower = 0.0;
    for (int scene = 0; scene < kScenes; ++scene) {
      const std::vector<Stroke> strokes = stroke(part, rng);
      const Recognition answer = recognise_as(CurveClass::Ellipse, strokes);
      const Recognition plain = recognise_as(CurveClass::Ellipse, without_details(strokes));
      ASSERT_EQ(answer.covariance.rows(), 5);
      ASSERT_EQ(plain.covariance.rows(), 5);
      const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
      const Eigen::Vector2d error = answer.shape.values.head<2>() - Eigen::Vector2d(0.03, 0.02);
      const double square = error.dot(covariance.inverse() * error);
      squares += square;
      beyond += square > chi_square_threshold(0.05, 2) ? 1 : 0;
      narrower += 0.5 * std::log(plain.covariance.topLeftCorner<2, 2>().determinant() /
                                 covariance.determinant());
    }
    std::printf(
        "noise %g times as long, normals of %g deg: e^T C^-1 e %.3f (law: 2), beyond 95 %%: "
        "%.1f %%, area of the region 1 / %.2f of that without details\n",
        told.longer, told.normal_sigma_rad / kDegree, squares / kScenes, 100.0 * beyond / kScenes,
        std::exp(narrower / kScenes));
    // Chi-square of 2 a scene: mean 2, variance 4; five deviations of the mean. The quadratic term
    // of errors of a hundredth of the part adds a hundredth.
    EXPECT_NEAR(squares / kScenes, 2.0, 5.0 * std::sqrt(4.0 / kScenes) + 0.02);
    EXPECT_GT(narrower / kScenes, 0.0);
  }
}

TEST(StrokesInFull, MotionScaleAndDirectionChangeNothing) {
  auto rng = test::test_rng();
  Stroked part;
  part.longer = 10.0;
  part.sigma_m = 1e-5;
  part.normal_sigma_rad = kDegree;
  const std::vector<Stroke> strokes = stroke(part, rng);
  const Recognition answer = recognise(strokes);
  ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
  const double sd = std::sqrt(answer.covariance(0, 0));
  const Pose2 motion{-3.0, 7.0, 2.1};
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(motion.theta).toRotationMatrix();
  std::vector<Stroke> moved = strokes;
  std::vector<Stroke> scaled = strokes;
  std::vector<Stroke> reversed = strokes;
  for (std::size_t p = 0; p < strokes.size(); ++p) {
    for (std::size_t i = 0; i < strokes[p].samples.size(); ++i) {
      SampleDetail& detail = moved[p].details[i];
      moved[p].samples[i].position_m = motion * moved[p].samples[i].position_m;
      detail.normal = turn * detail.normal;
      Eigen::Matrix2d c;
      c << detail.covariance_m2.x(), detail.covariance_m2.y(), detail.covariance_m2.y(),
          detail.covariance_m2.z();
      c = turn * c * turn.transpose();
      detail.covariance_m2 = {c(0, 0), c(0, 1), c(1, 1)};
      scaled[p].samples[i].position_m *= 1e3;
      scaled[p].samples[i].sigma_m *= 1e3;
      scaled[p].details[i].covariance_m2 *= 1e6;
    }
    std::reverse(reversed[p].samples.begin(), reversed[p].samples.end());
    std::reverse(reversed[p].details.begin(), reversed[p].details.end());
  }
  for (const auto& [other, unit] :
       {std::pair(recognise(moved), 1.0), std::pair(recognise(scaled), 1e3),
        std::pair(recognise(reversed), 1.0)}) {
    ASSERT_EQ(other.shape.curve_class, CurveClass::Ellipse);
    EXPECT_EQ(other.status, answer.status);
    // As far as the fits' tolerance goes, of chi-square 1e-6: a thousandth of a deviation.
    EXPECT_NEAR(other.shape.values[0] / unit, answer.shape.values[0], 2e-3 * sd);
    EXPECT_NEAR(std::sqrt(other.covariance(0, 0)) / unit, sd, 2e-3 * sd);
    EXPECT_NEAR(other.hypotheses.front().chi2, answer.hypotheses.front().chi2, 1e-3);
    EXPECT_NEAR(other.hypotheses.front().probability, answer.hypotheses.front().probability, 1e-2);
  }
}

TEST(StrokesInFull, TellTheClassAtLeastAsOften) {
  auto rng = test::test_rng();
  const auto is_right = [](const Recognition& answer, const Stroked& part) {
    return answer.status == RecognitionStatus::Recognized &&
           answer.shape.curve_class == class_of(part.curve);
  };
  for (const Told& told : kAllTold) {
    int with = 0;
    int without = 0;
    int wrong = 0;
    for (int round = 0; round < 6; ++round) {
      for (Stroked part : parts_of_all_classes()) {
        part.longer = told.longer;
        part.normal_sigma_rad = told.normal_sigma_rad;
        part.sigma_m = 2e-5;
        const std::vector<Stroke> strokes = stroke(part, rng);
        const Recognition answer = recognise(strokes);
        with += is_right(answer, part) ? 1 : 0;
        wrong += answer.status == RecognitionStatus::Recognized && !is_right(answer, part) ? 1 : 0;
        without += is_right(recognise(without_details(strokes)), part) ? 1 : 0;
      }
    }
    std::printf(
        "noise %g times as long, normals of %g deg: %d of 48 RECOGNIZED and right, %d "
        "wrong, without details %d\n",
        told.longer, told.normal_sigma_rad / kDegree, with, wrong, without);
    EXPECT_GE(with, without);
    // RECOGNIZED is wrong once in twenty: of 48 more than eight a few times in a million.
    EXPECT_LE(wrong, 8);
  }
}

TEST(StrokesInFull, WhatDoesNotCountIsSaid) {
  auto rng = test::test_rng();
  Stroked part;
  part.normal_sigma_rad = kDegree;
  std::vector<Stroke> strokes = stroke(part, rng);
  EXPECT_EQ(recognise(strokes).simplified_count, 0U);
  RecognizerOptions unqualified;  // neighbours may err together
  unqualified.unqualified_probe = true;
  const Recognition shared = recognise(strokes, unqualified);
  EXPECT_EQ(shared.simplified_count, 120U);
  EXPECT_EQ(shared.shape.values, recognise(without_details(strokes), unqualified).shape.values);
  for (Stroke& patch : strokes) {
    for (ContactSample& sample : patch.samples) sample.sigma_m = 0.0;
  }
  const Recognition of_unknown_noise = recognise(strokes);
  EXPECT_EQ(of_unknown_noise.simplified_count, 120U);
  EXPECT_EQ(of_unknown_noise.shape.values, recognise(without_details(strokes)).shape.values);
}

TEST(StrokesInFull, ASingleWrongNormalIsLeftAside) {
  auto rng = test::test_rng();
  Stroked part;
  part.normal_sigma_rad = kDegree;
  std::vector<Stroke> strokes = stroke(part, rng);
  const Recognition before = recognise(strokes);
  strokes[0].details[20].normal = Eigen::Rotation2Dd(0.5) * strokes[0].details[20].normal;
  const Recognition answer = recognise(strokes);
  EXPECT_EQ(answer.status, RecognitionStatus::Recognized);
  EXPECT_EQ(answer.outlier_count, 0U);
  EXPECT_EQ(answer.simplified_count, 1U);
  EXPECT_NEAR(answer.shape.values[0], before.shape.values[0], std::sqrt(before.covariance(0, 0)));
}

// The points lie on the curve; what the normals are of is another.
TEST(StrokesInFull, NormalsOfAnotherCurveAreAMisfit) {
  auto rng = test::test_rng();
  Stroked part;
  part.normal_sigma_rad = kDegree;
  std::vector<Stroke> strokes = stroke(part, rng);
  for (Stroke& patch : strokes) {
    for (std::size_t i = 0; i < patch.details.size(); ++i) {
      const double turn = (i % 2 == 0 ? 10.0 : -10.0) * kDegree;
      patch.details[i].normal = Eigen::Rotation2Dd(turn) * patch.details[i].normal;
    }
  }
  const Recognition answer = recognise(strokes);
  EXPECT_EQ(answer.status, RecognitionStatus::Ambiguous);
  EXPECT_EQ(answer.doubt, Doubt::Misfit);
}

}  // namespace
}  // namespace palpate
