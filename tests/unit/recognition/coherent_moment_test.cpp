// Deviations drawn from the law that the moment is taken under: what it says must hold of them.
#include "core/recognition/coherent/coherent_moment.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <random>
#include <vector>

#include "core/curves/ellipse.h"
#include "tests/support/ellipse_bound.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

constexpr double kSigmaNormalised = 1e-4;  // normalised: a metre is a half extent here
constexpr int kPerPatch = 24;
constexpr int kSamples = 600;  // that the points stand for

/// Two patches along the same arc, one of them back.
struct Touched {
  Ellipse ellipse{1.0, 0.7};
  FitData data;
  CanonicalFit placed;
  std::vector<double> normal_angle;
  Eigen::MatrixXd slopes;  ///< of the distances by shape and pose [m]
};

Touched touched(double arc) {
  Touched result;
  std::vector<Vec2> points;
  for (int patch = 0; patch < 2; ++patch) {
    result.data.patches.push_back({points.size(), points.size() + kPerPatch});
    for (int i = 0; i < kPerPatch; ++i) {
      const double share = (i + 0.5) / kPerPatch;
      const double t = 0.3 + arc * (patch == 0 ? share : 1.0 - share);
      const Vec2 outward(result.ellipse.b * std::cos(t), result.ellipse.a * std::sin(t));
      FittedPoint fitted;
      fitted.t = t;
      fitted.normal = outward.normalized();
      FitPoint point;
      point.position = result.ellipse.position(t);
      // Reduced points: each stands for its share of the samples.
      point.inverse_sigma = std::sqrt(kSamples / (2.0 * kPerPatch)) / kSigmaNormalised;
      result.data.points.push_back(point);
      result.placed.points.push_back(fitted);
      result.normal_angle.push_back(std::atan2(outward.y(), outward.x()));
      points.push_back(point.position);
    }
  }
  result.placed.shape = {CurveClass::Ellipse, {result.ellipse.a, result.ellipse.b, 0.0}};
  result.slopes = test::distance_slopes(result.ellipse, {}, points);
  const double weight = std::pow(result.data.points.front().inverse_sigma, 2);
  result.placed.covariance = (weight * result.slopes.transpose() * result.slopes).inverse();
  return result;
}

/// Sets the residuals that least squares leave of these distances; the error that they make of
/// shape and pose.
Eigen::VectorXd fit(const Eigen::VectorXd& distance_m, Touched* touched) {
  const Eigen::VectorXd off = touched->slopes.colPivHouseholderQr().solve(distance_m);
  const Eigen::VectorXd left = distance_m - touched->slopes * off;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    touched->placed.points[k].residual = left[i] * touched->data.points[k].inverse_sigma;
  }
  return off;
}

Eigen::VectorXd noise(const Touched& touched, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd result(static_cast<Eigen::Index>(touched.data.points.size()));
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    result[i] = normal(rng) / touched.data.points[static_cast<std::size_t>(i)].inverse_sigma;
  }
  return result;
}

/// A drift along each patch, an offset by direction of as many orders as it has: of sizes as they
/// are expected (core/README.md, "Deviations that neighbours share").
Eigen::VectorXd shared(const Touched& touched, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const double deviation = kSigmaNormalised * test::log_uniform(rng, 0.05, 5.0);
  double longest = 0.0;
  for (std::size_t i = 1; i < kPerPatch; ++i) {
    longest += (touched.data.points[i].position - touched.data.points[i - 1].position).norm();
  }
  const double length = std::ldexp(longest, -std::uniform_int_distribution<int>(1, 5)(rng));
  Eigen::VectorXd result(static_cast<Eigen::Index>(touched.data.points.size()));
  for (const PatchSpan& patch : touched.data.patches) {
    double drift = deviation * normal(rng);
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      if (i > patch.begin) {
        const double step =
            (touched.data.points[i].position - touched.data.points[i - 1].position).norm();
        const double kept = std::exp(-step / length);
        drift = kept * drift + std::sqrt(1.0 - kept * kept) * deviation * normal(rng);
      }
      result[static_cast<Eigen::Index>(i)] = drift;
    }
  }
  const double order = std::round(std::clamp(1.0 / length, 2.0, 8.0));
  std::student_t_distribution<double> student(3.0);
  const double size = std::abs(student(rng)) * deviation * order * order / 4.0;
  const int highest = std::uniform_int_distribution<int>(1, 8)(rng);  // 1: the constant alone
  const double constant = size * normal(rng);
  result.array() += constant;
  for (int k = 2; k <= highest; ++k) {
    const double cosine = size * 4.0 / (k * k) * normal(rng);
    const double sine = size * 4.0 / (k * k) * normal(rng);
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      const double phi = k * touched.normal_angle[static_cast<std::size_t>(i)];
      result[i] += cosine * std::cos(phi) + sine * std::sin(phi);
    }
  }
  return result;
}

Likelihood law() {
  Likelihood likelihood;
  likelihood.samples = kSamples;
  return likelihood;
}

/// What all samples leave about the points: as many squares as there are samples more.
constexpr double kScatter = kSamples - 2.0 * kPerPatch;

TEST(CoherentMoment, IsThatOfErrorsDrawnFromItsLaw) {
  std::mt19937_64 rng = test::test_rng();
  for (const bool noise_known : {true, false}) {
    for (const double arc : {2.0, kPi, 2.0 * kPi}) {
      Touched scene = touched(arc);
      Likelihood likelihood = law();
      likelihood.sigma_known = noise_known;
      double sum = 0.0;
      double squares = 0.0;
      int beyond = 0;
      const int runs = test::stress_count(200);
      for (int run = 0; run < runs; ++run) {
        const Eigen::VectorXd off = fit(shared(scene, rng) + noise(scene, rng), &scene);
        const auto told = coherent_moment(scene.placed, scene.data, likelihood, kSigmaNormalised,
                                          kScatter, test::unbounded_work());
        ASSERT_TRUE(told);
        const Eigen::MatrixXd moment = told->moment;
        const double square = off.dot(moment.ldlt().solve(off));
        sum += square;
        squares += square * square;
        beyond += square > 11.07 ? 1 : 0;
      }
      const double mean = sum / runs;
      const double error = std::sqrt((squares / runs - mean * mean) / runs);
      std::cout << (noise_known ? "noise known" : "noise not known") << ", arc " << arc
                << ": e^T M^-1 e " << mean << " +- " << error
                << " (law: 5), beyond 95 %: " << 100.0 * beyond / runs << " %\n";
      if (!test::counts_tell()) continue;
      // E[e^T M^-1 e | data] = tr(M^-1 M), whatever the law of the errors; these are of a narrower
      // range of sizes than the moment allows for, and its sizes are a factor of 2 apart, so that
      // the nearest is up to 2 off in variance.
      EXPECT_LE(mean, 5.0 + 4.0 * error);
      EXPECT_GE(mean, 0.5 * 5.0);
    }
  }
}

TEST(CoherentMoment, WhiteNoiseIsSeldomTakenForMore) {
  std::mt19937_64 rng = test::test_rng();
  Touched scene = touched(kPi);
  int taken = 0;
  const int runs = test::stress_count(400);
  // The odds of a law that is not the true one have the mean 1: beyond k they are in a k-th of
  // cases at most (Markov).
  constexpr double kOdds = 10.0;
  for (int run = 0; run < runs; ++run) {
    fit(noise(scene, rng), &scene);
    const auto told = coherent_moment(scene.placed, scene.data, law(), kSigmaNormalised, kScatter,
                                      test::unbounded_work());
    ASSERT_TRUE(told);
    taken += told->probability > kOdds / (1.0 + kOdds) ? 1 : 0;
  }
  const double share = 1.0 / kOdds;
  EXPECT_LE(taken, share * runs + 4.0 * std::sqrt(share * runs));
}

TEST(CoherentMoment, WithoutWhatIsSharedIsNoMoreThanTheBound) {
  std::mt19937_64 rng = test::test_rng();
  Touched scene = touched(2.0 * kPi);
  fit(noise(scene, rng), &scene);
  const auto told = coherent_moment(scene.placed, scene.data, law(), kSigmaNormalised, kScatter,
                                    test::unbounded_work());
  ASSERT_TRUE(told);
  EXPECT_LT(told->probability, 0.5);
  // Whatever is shared adds to it.
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_GE(told->moment(i, i), 0.99 * scene.placed.covariance(i, i));
  }
}

/// A reduced point with twice the samples is two points at its place.
TEST(CoherentMoment, DoesNotDependOnHowManyPointsStandForTheSamples) {
  std::mt19937_64 rng = test::test_rng();
  Touched scene = touched(kPi);
  fit(shared(scene, rng) + noise(scene, rng), &scene);
  const auto moment_of = [](const Touched& points) {
    return coherent_moment(points.placed, points.data, law(), kSigmaNormalised, kScatter,
                           test::unbounded_work());
  };
  const auto told = moment_of(scene);
  Touched split = scene;
  split.data.points.clear();
  split.placed.points.clear();
  for (PatchSpan& patch : split.data.patches) {
    const std::size_t begin = split.data.points.size();
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      // Every point of the first half of a patch.
      const int parts = 2 * (i - patch.begin) < patch.size() ? 2 : 1;
      for (int part = 0; part < parts; ++part) {
        split.data.points.push_back(scene.data.points[i]);
        split.data.points.back().inverse_sigma /= std::sqrt(parts);
        split.placed.points.push_back(scene.placed.points[i]);
        split.placed.points.back().residual /= std::sqrt(parts);
      }
    }
    patch = {begin, split.data.points.size()};
  }
  const auto by_parts = moment_of(split);
  ASSERT_TRUE(told && by_parts);
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_NEAR(by_parts->moment(i, i), told->moment(i, i), 1e-6 * told->moment(i, i));
  }
}

}  // namespace
}  // namespace palpate
