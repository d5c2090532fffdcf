#include "core/recognition/modes/across_circle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/curves/ellipse.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat5 = Eigen::Matrix<double, 5, 5>;

/// [a; b; x; y; theta] of [mean radius; ovality; centre].
Vec5 ellipse_of(const Vec5& oval) {
  const double ovality = oval.segment<2>(1).norm();
  Vec5 ellipse;
  ellipse << oval[0] + ovality, oval[0] - ovality, oval.tail<2>(),
      0.5 * std::atan2(oval[2], oval[1]);
  return ellipse;
}

Vec5 difference(const Vec5& b, const Vec5& a) {
  Vec5 d = b - a;
  d[4] = std::remainder(d[4], std::numbers::pi);
  return d;
}

CanonicalFit fit_at(const Vec5& oval) {
  const Vec5 q = ellipse_of(oval);
  CanonicalFit fit;
  fit.shape = {CurveClass::Ellipse, {q[0], q[1], 0.0}};
  fit.world_T_curve = {q[2], q[3], q[4]};
  return fit;
}

/// The covariance of [a; b; x; y; theta] to first order, by differences.
Mat5 linear_at(const Vec5& oval, const Mat5& root) {
  const double step = 1e-6 * oval.segment<2>(1).norm();
  Mat5 jacobian;
  for (int k = 0; k < 5; ++k) {
    const Vec5 by = step * Vec5::Unit(k);
    jacobian.col(k) = difference(ellipse_of(oval + by), ellipse_of(oval - by)) / (2.0 * step);
  }
  const Mat5 half = jacobian * root;
  return half * half.transpose();
}

TEST(AcrossCircle, IsTheMomentOfItsLaw) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  const int draws = test::stress_count(200000);
  for (const double deviations : {0.3, 1.0, 2.5}) {
    Vec5 oval;
    oval << 25.0, 0.1 * std::cos(1.0), 0.1 * std::sin(1.0), 3.0, -2.0;
    Mat5 root;  // mean radius and centre follow the ovality, which is loose in one direction
    for (int i = 0; i < 25; ++i) {
      root(i / 5, i % 5) = 0.02 * normal(rng);
    }
    root.row(1) *= 0.2;
    root.col(0) = 0.1 / deviations * Vec5(-1.0, 0.8, 0.6, 0.3, -0.4);
    const auto moment = moment_across_circle(fit_at(oval), linear_at(oval, root));
    ASSERT_TRUE(moment.has_value());
    Mat5 sum = Mat5::Zero();
    Mat5 squares = Mat5::Zero();
    for (int i = 0; i < draws; ++i) {
      Vec5 z;
      for (double& part : z) {
        part = normal(rng);
      }
      const Vec5 away = difference(ellipse_of(oval + root * z), ellipse_of(oval));
      const Mat5 product = away * away.transpose();
      sum += product;
      squares += product.cwiseProduct(product);
    }
    const Mat5 mean = sum / draws;
    // Five deviations of the mean drawn, and what a step of a third of a deviation leaves at the
    // circle: a sixth of one, of density 0.4, and the squares jump there.
    const Mat5 spread = ((squares / draws - mean.cwiseProduct(mean)) / draws).cwiseSqrt();
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 5; ++j) {
        const double size = std::sqrt(mean(i, i) * mean(j, j));
        EXPECT_NEAR((*moment)(i, j), mean(i, j), 5.0 * spread(i, j) + 0.07 * size)
            << deviations << ": " << i << ", " << j;
      }
    }
  }
}

TEST(AcrossCircle, IsLinearFarFromIt) {
  Vec5 oval;
  oval << 25.0, 4.0, 3.0, 3.0, -2.0;
  const Mat5 root = 0.6 * Mat5::Identity();
  const Mat5 linear = linear_at(oval, root);
  const auto moment = moment_across_circle(fit_at(oval), linear);  // 8 deviations
  ASSERT_TRUE(moment.has_value());
  EXPECT_LT((*moment - linear).norm(), 0.05 * linear.norm());
  EXPECT_FALSE(moment_across_circle(fit_at(oval), 0.5 * linear).has_value());
}

/// Two short strokes of a ring that is a little oval: the diameter between them is told well, its
/// ovality hardly.
TEST(AcrossCircle, DeviationsHoldOfRingsTouchedAtTwoPlaces) {
  constexpr double kSigma = 1.25e-5;
  constexpr double kA = 0.025;
  constexpr int kSamples = 150;
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, kSigma);
  const int scenes = test::stress_count(200);
  double squares = 0.0;
  int axes = 0;
  int far = 0;
  for (int i = 0; i < scenes; ++i) {
    const Ellipse ring{kA, kA * test::uniform(rng, 0.97, 0.995)};
    Recognizer recognizer;
    for (std::uint32_t p = 0; p < 2; ++p) {
      const double begin = test::uniform(rng, 0.0, 2.0 * kPi);
      std::vector<ContactSample> samples;
      for (int k = 0; k < kSamples; ++k) {
        const double t = begin + 10.0 / 180.0 * kPi * k / (kSamples - 1);
        samples.push_back({ring.position(t) + Vec2(noise(rng), noise(rng)), kSigma, 0});
      }
      PatchContext context;
      context.patch = p;
      recognizer.add(context, samples);
    }
    const Recognition answer = recognizer.recognize();
    if (answer.status != RecognitionStatus::Recognized ||
        answer.shape.curve_class != CurveClass::Ellipse) {
      continue;
    }
    const double of_a = (answer.shape.values[0] - ring.a) / std::sqrt(answer.covariance(0, 0));
    const double of_b = (answer.shape.values[1] - ring.b) / std::sqrt(answer.covariance(1, 1));
    squares += of_a * of_a + of_b * of_b;
    axes += 2;
    far += std::max(std::abs(of_a), std::abs(of_b)) > 5.0 ? 1 : 0;
  }
  // Rings are told to be oval more often where noise makes them so: half as much again at most.
  EXPECT_LT(squares, 1.5 * axes + 5.0 * std::sqrt(2.0 * axes));
  EXPECT_LE(far, 0.01 * axes + 1.0);
  EXPECT_GT(axes, scenes / 5);
}

}  // namespace
}  // namespace palpate
