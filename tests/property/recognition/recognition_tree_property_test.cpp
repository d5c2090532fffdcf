// Properties of the recognition tree over random curves of every class.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "core/curves/length_powers.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/tree/recognition_tree.h"
#include "tests/support/calibration.h"
#include "tests/support/canonical_points.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::PlacedCurve;

/// Adds independent Gaussian errors to angle, kappa and kappa_s, relative to each point's size, and
/// the covariance of these errors.
void add_noise(std::vector<TreePoint>& points, double relative, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  for (TreePoint& point : points) {
    LocalEstimate& e = point.estimate;
    const double size = std::max(std::abs(e.kappa), std::sqrt(std::abs(e.kappa_s)));
    const Eigen::Vector3d sd = relative * Eigen::Vector3d(0.3, size, 3.0 * size * size);
    e.covariance.diagonal() << 1e-12, sd[0] * sd[0], sd[1] * sd[1], sd[2] * sd[2];
    e.tangent_angle += sd[0] * normal(rng);
    e.kappa += sd[1] * normal(rng);
    e.kappa_s += sd[2] * normal(rng);
  }
}

class TreeOfEveryClass : public testing::TestWithParam<CurveClass> {};

INSTANTIATE_TEST_SUITE_P(RecognitionTree, TreeOfEveryClass,
                         testing::ValuesIn(test::invariant_classes().begin(),
                                           test::invariant_classes().end()),
                         [](const auto& param_info) {
                           return std::string(name_of(param_info.param));
                         });

TEST_P(TreeOfEveryClass, NoiseThatTheCovarianceTellsOfIsNoReasonToRejectIt) {
  auto rng = test::test_rng();
  const int cases = test::stress_count(300);
  for (const double noise : {1e-5, 1e-3, 1e-2}) {
    int right = 0;
    int within = 0;
    for (int i = 0; i < cases; ++i) {
      const PlacedCurve curve = test::random_curve(GetParam(), rng);
      auto points = test::exact_points(curve, test::random_places(curve, 6, rng), rng);
      add_noise(points, noise, rng);
      const TreeResult result = recognise_by_tree(points);
      if (result.shape.curve_class == GetParam()) {
        ++right;
        within += std::abs(result.shape.values[0] - curve.parameters[0]) <
                          2.0 * std::sqrt(result.covariance(0, 0))
                      ? 1
                      : 0;
      }
    }
    if (!test::counts_tell()) {
      continue;
    }
    // A path of at most three tests at 0.1 % each may lose 0.3 %. 2 % allows for chance and for
    // curves that a simpler class explains as well.
    EXPECT_GE(right, cases * 98 / 100) << noise;
    // 95.4 % for a Gaussian; the binomial standard deviation is 1.2 %.
    EXPECT_NEAR(static_cast<double>(within) / right, 0.954, 0.045) << noise;
  }
}

TEST_P(TreeOfEveryClass, ClassAndShapeDoNotDependOnUnitPlaceOrOrder) {
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(30); ++i) {
    const PlacedCurve curve = test::random_curve(GetParam(), rng);
    auto points = test::exact_points(curve, test::random_places(curve, 6, rng), rng);
    add_noise(points, 1e-3, rng);
    const TreeResult result = recognise_by_tree(points);
    for (const double factor : {1e-6, 1.0, 1e6}) {
      auto changed = points;
      std::shuffle(changed.begin(), changed.end(), rng);
      for (TreePoint& point : changed) {
        LocalEstimate& e = point.estimate;
        e.position = factor * e.position + Vec2(1e6, -1e6) * factor;
        e.kappa /= factor;
        e.kappa_s /= factor * factor;
        const Eigen::Vector4d units(factor, 1.0, 1.0 / factor, 1.0 / (factor * factor));
        e.covariance = units.asDiagonal() * e.covariance * units.asDiagonal();
      }
      const TreeResult other = recognise_by_tree(changed);
      ASSERT_EQ(other.shape.curve_class, result.shape.curve_class) << factor;
      const Eigen::Vector3d powers = length_powers(GetParam());
      for (int k = 0; k < 3; ++k) {
        const double back = other.shape.values[k] * std::pow(factor, -powers[k]);
        // Both are the same minimum, each found to far less than its standard deviation.
        EXPECT_NEAR(back, result.shape.values[k], 1e-2 * std::sqrt(result.covariance(k, k)) + 1e-12)
            << factor;
      }
    }
  }
}

TEST(RecognitionTreeProperty, RejectsTheTrueClassAsSeldomAsItsSignificanceSays) {
  // A class passes at most three tests. The distribution of the estimates is not exactly normal,
  // hence twice that.
  constexpr double kTests = 3.0;
  constexpr double kSlack = 2.0;
  const double significance = RecognizerOptions{}.tree.significance;
  const test::ScenePrior prior = test::classes_only(test::even_prior());
  const int scenes = test::stress_count(1000);
  std::vector<double> stated;
  int rejected = 0;
  for (int i = 0; i < scenes; ++i) {
    const test::PriorScene drawn =
        test::scene_from(prior, test::test_seed(), static_cast<std::uint32_t>(i));
    const Recognition answer = test::recognise(drawn.scene, drawn.scene.sigma_m);
    const double p = answer.tree_p_values[static_cast<std::size_t>(drawn.scene.curve_class)];
    if (std::isnan(p)) {
      continue;
    }
    stated.push_back(kSlack * kTests * significance);
    rejected += p < significance ? 1 : 0;
    // If they disagree the answer says so.
    const bool rejects =
        answer.tree_p_values[static_cast<std::size_t>(answer.shape.curve_class)] < significance;
    EXPECT_FALSE(rejects && answer.status == RecognitionStatus::Recognized) << "scene " << i;
    EXPECT_TRUE(rejects || answer.doubt != Doubt::TreeRejects) << "scene " << i;
  }
  EXPECT_GT(stated.size(), static_cast<std::size_t>(scenes / 2));
  EXPECT_LE(rejected, test::binomial_band(stated, 0.999).most) << "of " << stated.size();
  std::cout << rejected << " of " << stated.size() << " rejected\n";
}

/// `within` of `count` errors are within two deviations, as for normal distributions, to four
/// deviations of that share. The errors of one answer are correlated: three count as one.
void expect_two_deviations(int within, int count, const std::string& what) {
  if (!test::counts_tell()) return;
  ASSERT_GT(count, 30) << what;
  constexpr double kLaw = 0.9545;
  const double tolerance = 4.0 * std::sqrt(kLaw * (1.0 - kLaw) * 3.0 / count);
  const double share = within / static_cast<double>(count);
  EXPECT_GE(share, kLaw - tolerance) << what;
  EXPECT_LE(share, std::min(1.0, kLaw + tolerance)) << what;
}

/// From strokes to pose by local estimates alone: published errors must be within two published
/// deviations as often as normal ones.
TEST(RecognitionTree, ShapeAndPoseErrAsTheirPropagatedCovarianceSays) {
  RecognizerOptions options;
  options.method = RecognitionMethod::Tree;
  const int scenes = test::stress_count(60);
  int all = 0;
  int all_within = 0;
  for (const CurveClass curve_class : kCurveClasses) {
    auto rng = test::test_rng();
    int count = 0;
    int within = 0;
    for (int i = 0; i < scenes; ++i) {
      test::SceneOptions scene_options;
      scene_options.patches = 4;
      scene_options.sigma_over_size = 1e-4;
      const test::Scene scene = test::random_scene(curve_class, scene_options, rng);
      const Recognition answer = test::recognise(scene, scene.sigma_m, options);
      if (answer.status != RecognitionStatus::Recognized ||
          answer.shape.curve_class != curve_class) {
        continue;
      }
      const Eigen::VectorXd error = test::error_of(answer.hypotheses.front(), scene);
      for (Eigen::Index k = 0; k < error.size(); ++k) {
        const double deviation = std::sqrt(answer.covariance(k, k));
        if (curve_class == CurveClass::Line ? k != 2 : deviation == 0.0) continue;
        ASSERT_TRUE(std::isfinite(deviation)) << name_of(curve_class);
        ++count;
        const double off =
            curve_class == CurveClass::Line ? std::remainder(error[k], kPi) : error[k];
        within += std::abs(off) < 2.0 * deviation ? 1 : 0;
      }
    }
    expect_two_deviations(within, count, std::string(name_of(curve_class)));
    all += count;
    all_within += within;
  }
  expect_two_deviations(all_within, all, "all");
}

}  // namespace
}  // namespace palpate
