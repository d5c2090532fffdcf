// Checks the published joint covariance of shape and pose of RECOGNIZED answers: over thousands of
// random scenes, the squared Mahalanobis distance of the truth against its chi-square law.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "core/numerics/probability/chi_square.h"
#include "core/recognition/weigh/weigh.h"
#include "tests/support/joint_error.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

constexpr double kNoiseLevels[] = {1e-8, 1e-5, 1e-4, 5e-4, 1e-3, 2e-3};
constexpr int kScenesPerCell = 25;  // 4 numbers of patches x 6 levels x 25 = 600 scenes per class

/// Probability that the truth is beyond the chi-square quantile of `significance` when the
/// covariance is the second moment of a valley that bends like a parabola. At k standard deviations
/// along the valley, the squared distance is k^2 + (e + sqrt(r / 3) k^2)^2 / (1 + r) plus a
/// chi-square variable with two degrees of freedom less. e is normal; r is the variance that the
/// bend adds, divided by that across the valley.
double probability_beyond(int dof, double variance_ratio, double significance) {
  constexpr double kStep = 0.1;
  constexpr double kFarthest = 7.0;
  const double threshold = chi_square_threshold(significance, dof);
  const double by_k2 = std::sqrt(variance_ratio / 3.0);
  const auto density = [](double x) {
    return std::exp(-0.5 * x * x) / std::sqrt(2.0 * kPi) * kStep;
  };
  double sum = 0.0;
  for (double k = 0.5 * kStep; k < kFarthest; k += kStep) {
    for (double e = -kFarthest; e < kFarthest; e += kStep) {
      const double across = std::pow(e + by_k2 * k * k, 2) / (1.0 + variance_ratio);
      sum +=
          2.0 * density(k) * density(e) * chi_square_survival(threshold - k * k - across, dof - 2);
    }
  }
  return sum;
}

/// The largest such probability over all bends of a parabola, from none to nothing but bend.
double most_beyond(int dof, double significance) {
  double most = significance;
  for (double ratio = 1e-3; dof > 2 && ratio < 1e6; ratio *= 2.0) {
    most = std::max(most, probability_beyond(dof, ratio, significance));
  }
  return most;
}

/// The count that a binomial variable exceeds with a probability below `false_alarm`.
int binomial_bound(int trials, double probability, double false_alarm) {
  double term = std::pow(1.0 - probability, trials);
  double tail = 1.0 - term;
  int count = 0;
  while (tail > false_alarm && count < trials) {
    term *= (trials - count) / (count + 1.0) * probability / (1.0 - probability);
    tail -= term;
    ++count;
  }
  return count;
}

constexpr double kOuter = 1e-4;
constexpr double kInner = 0.05;

struct Count {
  int recognized = 0;
  int beyond_outer = 0;
  int beyond_inner = 0;
  int outer_by_bound = 0;  ///< by the covariance linearised at the estimate
};

/// Counts an answer if it is RECOGNIZED as the true class.
void add(const Recognition& answer, const test::Scene& scene, Count* count) {
  if (answer.status != RecognitionStatus::Recognized ||
      answer.shape.curve_class != scene.curve_class) {
    return;
  }
  const int dof = degrees_of_freedom(scene.curve_class);
  const double published =
      test::squared_distance(test::joint_error(answer.hypotheses.front(), scene));
  ++count->recognized;
  count->beyond_outer += published > chi_square_threshold(kOuter, dof) ? 1 : 0;
  count->beyond_inner += published > chi_square_threshold(kInner, dof) ? 1 : 0;
  // The covariance linearised at the estimate, from the points before any is set aside as a spike.
  const Weighing w = weigh(test::fit_data(scene, scene.sigma_m), {}, test::unbounded_work());
  const auto& fit = w.canonical[static_cast<std::size_t>(scene.curve_class)];
  if (w.best == scene.curve_class && fit) {
    Hypothesis linear = answer.hypotheses.front();
    linear.covariance = w.inflation * fit->covariance;
    const double by_bound = test::squared_distance(test::joint_error(linear, scene));
    count->outer_by_bound += by_bound > chi_square_threshold(kOuter, dof) ? 1 : 0;
  }
}

TEST(JointCovariance, SecondMomentHoldsTheTruthHoweverTheValleyBends) {
  std::cout << "the 95 % ellipsoid of a valley that bends leaves the truth out, at most\n";
  for (int dof = 4; dof <= 6; ++dof) {
    const double most = most_beyond(dof, kInner);
    std::cout << "  " << dof << " degrees of freedom\t" << 100.0 * most << " %\n";
    EXPECT_LT(most, 0.08);
  }
}

TEST(JointCovariance, OfRecognizedAnswersHoldsTheTruth) {
  constexpr double kFalseAlarm = 1e-6;
  std::mt19937_64 rng = test::test_rng();
  int beyond = 0;
  int beyond_by_bound = 0;
  std::cout << "truth beyond the 95 % ellipsoid, most by the law; beyond the quantile of " << kOuter
            << ", most by the law; by the bound alone; RECOGNIZED\n";
  for (const CurveClass curve_class : kCurveClasses) {
    Count count;
    for (const double level : kNoiseLevels) {
      for (int patches = 1; patches <= 4; ++patches) {
        for (int i = 0; i < test::stress_count(kScenesPerCell); ++i) {
          test::SceneOptions options;
          options.patches = patches;
          options.sigma_over_size = level;
          const test::Scene scene = test::random_scene(curve_class, options, rng);
          add(test::recognise(scene, scene.sigma_m), scene, &count);
        }
      }
    }
    const int dof = degrees_of_freedom(curve_class);
    const int most_inner = binomial_bound(count.recognized, most_beyond(dof, kInner), kFalseAlarm);
    const int most_outer = binomial_bound(count.recognized, most_beyond(dof, kOuter), kFalseAlarm);
    std::cout << "  " << name_of(curve_class) << "\t" << count.beyond_inner << "\t" << most_inner
              << "\t" << count.beyond_outer << "\t" << most_outer << "\t" << count.outer_by_bound
              << "\t" << count.recognized << "\n";
    if (test::counts_tell()) {
      EXPECT_GT(count.recognized, 0) << name_of(curve_class);
    }
    EXPECT_LE(count.beyond_inner, most_inner) << name_of(curve_class);
    EXPECT_LE(count.beyond_outer, most_outer) << name_of(curve_class);
    beyond += count.beyond_outer;
    beyond_by_bound += count.outer_by_bound;
  }
  std::cout << "  all beyond the quantile of " << kOuter << ": " << beyond
            << ", by the bound alone " << beyond_by_bound << "\n";
  if (!test::counts_tell()) {
    return;
  }
  // The same count detects bends if the covariance ignores them.
  EXPECT_GT(beyond_by_bound, beyond);
}

}  // namespace
}  // namespace palpate
