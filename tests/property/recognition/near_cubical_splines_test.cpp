// Splines that are nearly cubical parabolas, as parts drawn otherwise often are: of a small
// quadratic term q in x, their vertex lies q^-3 extents away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/algebraic/canonical_cubic.h"
#include "core/curves/curve.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/prior/touched_prior.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// One stroke along an arc of such a spline.
struct NearCubical {
  std::vector<Vec2> touched_m;
  double sigma_m = 0.0;
  double chi2_of_truth = 0.0;                 ///< distances of the points from the true curve
  TouchedVector arc = TouchedVector::Zero();  ///< coordinates about its middle
  PolynomialCoefficients coefficients;
};

/// `least_q`, `most_q`: of the quadratic term of x over the linear one, at the end of the arc.
NearCubical near_cubical(double least_q, double most_q, double sigma, int count,
                         std::mt19937_64& rng) {
  const double theta = test::uniform(rng, -kPi, kPi);
  const Vec2 x(std::cos(theta), std::sin(theta));
  PolynomialFit truth;
  PolynomialCoefficients& c = truth.coefficients;
  c.col(1) = x + test::uniform(rng, -1.0, 1.0) * left_of(x);
  const double q = most_q > 0.0 ? test::log_uniform(rng, least_q, most_q) : 0.0;
  c.col(2) = test::random_sign(rng) * q * x + test::uniform(rng, -1.0, 1.0) * left_of(x);
  c.col(3) = test::random_sign(rng) * test::uniform(rng, 0.5, 1.5) * left_of(x);
  NearCubical scene;
  scene.coefficients = c;
  const double speed = c.col(1).norm();
  const Vec2 tangent = c.col(1) / speed;
  const Vec2 second = 2.0 / (speed * speed) * c.col(2);
  const Vec2 third = 6.0 / (speed * speed * speed) * c.col(3);
  scene.arc.head<4>() << tangent.dot(second), cross(tangent, second), tangent.dot(third),
      cross(tangent, third);
  scene.sigma_m = sigma;  // of a half extent of about 1
  std::normal_distribution<double> normal(0.0, sigma);
  for (int i = 0; i < count; ++i) {
    const double t = 2.0 * i / (count - 1) - 1.0;
    const double along = normal(rng);
    FitPoint point;
    point.position = position_at(c, t) + Vec2(along, normal(rng));
    scene.touched_m.push_back(point.position);
    const double residual = place_on(truth, t, point).signed_distance / sigma;
    scene.chi2_of_truth += residual * residual;
  }
  return scene;
}

/// Its noise stated.
Recognition answer_to(const NearCubical& scene, const RecognizerOptions& options = {}) {
  std::vector<ContactSample> samples;
  for (const Vec2& touched_m : scene.touched_m) {
    samples.push_back({touched_m, scene.sigma_m, 0});
  }
  Recognizer recognizer(options);
  recognizer.add({0, 0}, samples);
  return recognizer.recognize();
}

/// Chi-square of the curve in the parameters that are told.
double chi2_as_told(const ShapeParameters& shape, const Pose2& world_T_curve,
                    const NearCubical& scene) {
  const auto curve = make_curve(shape.curve_class, shape.values);
  double chi2 = 0.0;
  for (const Vec2& touched_m : scene.touched_m) {
    const double residual =
        foot_point(*curve, world_T_curve.to_local(touched_m)).distance / scene.sigma_m;
    chi2 += residual * residual;
  }
  return chi2;
}

TEST(NearCubicalSplines, AGivenOneIsOfLeastSquaresOrNotTold) {
  const int scenes = test::stress_count(60);
  constexpr int kCount = 60;
  int fitted = 0;
  for (int i = 0; i < scenes; ++i) {
    std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(i));
    const double sigma = test::log_uniform(rng, 1e-5, 3e-3);
    // Nearer to the cubical parabola the points do not tell it from one.
    const NearCubical scene = near_cubical(10.0 * sigma, 0.1, sigma, kCount, rng);
    std::vector<GivenPoint> points;
    for (const Vec2& touched_m : scene.touched_m) {
      GivenPoint& point = points.emplace_back();
      point.position_m = touched_m;
      point.sigma_m = sigma;
      point.stroke = 1;
    }
    const GivenFit fit = fit_given_class(CurveClass::CubicSpline, points);
    if (fit.status != GivenStatus::Fitted) {
      continue;
    }
    ++fitted;
    // Nothing fits better than least squares, to their rounding.
    EXPECT_LE(fit.chi2, scene.chi2_of_truth + 1e-6 * kCount) << i;
    // Rounding of the parameters moves the curve by a tenth of the noise at most.
    EXPECT_LE(std::sqrt(chi2_as_told(fit.shape, fit.world_T_curve, scene)),
              std::sqrt(fit.chi2) + 0.1 * std::sqrt(kCount))
        << i;
  }
  std::cout << "of " << scenes << ": fitted " << fitted << '\n';
  if (test::counts_tell()) {
    EXPECT_GE(10 * fitted, 9 * scenes);
  }
}

TEST(NearCubicalSplines, HaveWhatThePriorLeavesThem) {
  const int scenes = test::stress_count(300);
  constexpr int kCount = 200;
  int recognized = 0;
  int other = 0;
  double least = 1.0;
  for (int i = 0; i < scenes; ++i) {
    std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(i));
    const double sigma = test::log_uniform(rng, 1e-5, 3e-3);
    const NearCubical scene = near_cubical(1e-4, 0.1, sigma, kCount, rng);
    const Recognition answer = answer_to(scene);
    double of_spline = 0.0;
    for (const auto& hypothesis : answer.hypotheses) {
      of_spline +=
          hypothesis.shape.curve_class == CurveClass::CubicSpline ? hypothesis.probability : 0.0;
    }
    // Where the data leave the spline no more than its limit, that is cheaper by a coordinate: by
    // its deviation, which is that of the mean of all points or more, over its prior's width, about
    // 1. And an arc's density is what its tails leave there, a cubical parabola's at most all.
    constexpr double kCoordinates = 100.0;  // what the two priors' differ by beside that
    const double left = std::exp(log_prior({CurveClass::CubicSpline, true}, scene.arc));
    EXPECT_GT(of_spline, sigma / std::sqrt(kCount) * left / kCoordinates) << i;
    least = std::min(least, of_spline);
    const bool certain = answer.status == RecognitionStatus::Recognized;
    const CurveClass told = answer.shape.curve_class;
    recognized += certain && told == CurveClass::CubicSpline ? 1 : 0;
    other += certain && told != CurveClass::CubicSpline && told != CurveClass::CubicalParabola;
  }
  std::cout << "of " << scenes << ": RECOGNIZED as splines " << recognized
            << ", as what they are not nearly " << other << ", P of a spline at least " << least
            << '\n';
}

/// Shape and pose of such a spline make up for one another to many digits: a product of their
/// derivatives has lost what that direction is told by.
TEST(NearCubicalSplines, DeviationsAreAsStated) {
  const int scenes = test::stress_count(60);
  constexpr int kCount = 60;
  constexpr double kSigma = 1e-5;
  double squares = 0.0;
  int told = 0;
  for (int i = 0; i < scenes; ++i) {
    std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(i));
    const NearCubical scene = near_cubical(3e-3, 2e-2, kSigma, kCount, rng);
    const Recognition answer = answer_to(scene);
    if (answer.shape.curve_class != CurveClass::CubicSpline || !answer.covariance.allFinite()) {
      continue;
    }
    const auto truth =
        canonicalise_as(CurveClass::CubicSpline, PolynomialCurve2{scene.coefficients}).curve;
    const double off = answer.shape.values[0] - truth->values[0];
    squares += off * off / answer.covariance(0, 0);
    ++told;
  }
  std::cout << "of " << scenes << ": told " << told
            << ", mean square of a's error over its variance " << squares / told << '\n';
  EXPECT_GE(10 * told, 9 * scenes);
  EXPECT_TRUE(can_be_noise(squares, told)) << squares;
  // Nor too wide, by as many deviations of chi-square's law.
  EXPECT_GT(squares, told - kNegligibleDeviations * std::sqrt(2.0 * told));
}

/// A cubical parabola is a spline at its limit: given as one, it is told as a curve that has its
/// points, or as undetermined.
TEST(NearCubicalSplines, CubicalParabolasGivenAsSplinesHaveTheirPoints) {
  const int scenes = test::stress_count(60);
  constexpr int kCount = 80;
  constexpr double kSigma = 1e-4;
  int recognized = 0;
  for (int i = 0; i < scenes; ++i) {
    std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(i));
    const NearCubical scene = near_cubical(0.0, 0.0, kSigma, kCount, rng);
    RecognizerOptions options;
    options.classes = class_bit(CurveClass::CubicSpline);
    const Recognition answer = answer_to(scene, options);
    if (answer.status != RecognitionStatus::Recognized ||
        answer.shape.curve_class != CurveClass::CubicSpline) {
      continue;
    }
    ++recognized;
    EXPECT_GT(answer.covariance.diagonal().minCoeff(), 0.0) << i;
    const double chi2 = chi2_as_told(answer.shape, answer.world_T_curve, scene);
    EXPECT_TRUE(can_be_noise(chi2, kCount)) << i << ": " << chi2;
  }
  std::cout << "of " << scenes << ": RECOGNIZED " << recognized << '\n';
}

}  // namespace
}  // namespace palpate
