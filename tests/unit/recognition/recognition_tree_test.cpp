#include "core/recognition/tree/recognition_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "tests/support/canonical_points.h"
#include "tests/support/reference_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

std::string path_of(const TreeResult& result) {
  std::string path;
  for (const Decision& decision : result.decisions) {
    path += std::string(decision.test) + (decision.passed ? " yes" : " no") + " (" +
            std::to_string(decision.value) + " / " + std::to_string(decision.threshold) + "); ";
  }
  return path;
}

TEST(ChiSquare, AgreesWithTabulatedValues) {
  // Abramowitz and Stegun, table 26.8.
  EXPECT_NEAR(chi_square_threshold(0.05, 1), 3.84146, 5e-6);
  EXPECT_NEAR(chi_square_threshold(0.05, 2), 5.99146, 5e-6);
  EXPECT_NEAR(chi_square_threshold(0.001, 3), 16.2662, 5e-5);
  EXPECT_NEAR(chi_square_threshold(0.01, 10), 23.2093, 5e-5);
  EXPECT_NEAR(chi_square_threshold(0.5, 30), 29.3360, 5e-5);
  EXPECT_EQ(chi_square_threshold(0.05, 0), 0.0);
  EXPECT_NEAR(chi_square_survival(124.342, 100), 0.05, 1e-6);
  EXPECT_EQ(chi_square_survival(0.0, 5), 1.0);
  EXPECT_TRUE(std::isnan(chi_square_survival(std::numeric_limits<double>::quiet_NaN(), 5)));
  for (const int dof : {1, 2, 3, 4}) {
    EXPECT_EQ(chi_square_survival(std::numeric_limits<double>::infinity(), dof), 0.0);
  }
}

/// The class's invariants by the paper's closed forms.
std::map<std::string, double> true_invariants(CurveClass curve_class, const Eigen::Vector3d& p) {
  const double product = p[0] * p[1];
  const auto two_thirds = [](double x) { return std::cbrt(x * x); };
  switch (curve_class) {
    case CurveClass::Ellipse:
      return {{"Ic1", 1.0 / two_thirds(product)},
              {"Ic2", (p[0] * p[0] + p[1] * p[1]) / two_thirds(product * product)}};
    case CurveClass::Hyperbola:
      return {{"Ic1", -1.0 / two_thirds(product)},
              {"Ic2", (p[0] * p[0] - p[1] * p[1]) / two_thirds(product * product)}};
    case CurveClass::Parabola:
      return {{"Ip", 1.0 / two_thirds(2.0 * p[0])}};
    case CurveClass::CubicalParabola:
      return {{"Icp1", p[0]}, {"Icp2", p[1]}};
    case CurveClass::SemiCubicalParabola:
      return {{"Iscp1", p[0] * p[0]}, {"Iscp2", p[1]}};
    case CurveClass::CubicSpline:
      return {{"a", p[0]}, {"b", p[1]}, {"c", p[2]}};
    default:
      return {};
  }
}

/// A random curve of the class and what the tree says of five exact points of it.
struct ExactWalk {
  test::PlacedCurve curve;
  TreeResult result;
};

ExactWalk walk_exactly(CurveClass curve_class, std::mt19937_64& rng) {
  const test::PlacedCurve curve = test::random_curve(curve_class, rng);
  const auto places = test::random_places(curve, 5, rng);
  return {curve, recognise_by_tree(test::exact_points(curve, places, rng))};
}

TEST(RecognitionTree, InvariantsOfExactPointsAreTheClosedForms) {
  auto rng = test::test_rng();
  const int cases = test::stress_count(100);
  for (const CurveClass curve_class : test::invariant_classes()) {
    for (int i = 0; i < cases; ++i) {
      const auto [curve, result] = walk_exactly(curve_class, rng);
      if (result.shape.curve_class != curve_class) {
        continue;
      }
      std::map<std::string, double> expected = true_invariants(curve_class, curve.parameters);
      for (const NamedInvariant& invariant : result.invariants) {
        const auto truth = expected.find(std::string(invariant.name));
        if (invariant.curve_class != curve_class || truth == expected.end()) {
          continue;
        }
        // The floor of 1e-6 is the noise that the tree assumes of exact points.
        EXPECT_NEAR(invariant.value, truth->second, 5.0 * invariant.sigma + 1e-12)
            << name_of(curve_class) << " " << invariant.name;
        EXPECT_TRUE(std::isfinite(invariant.sigma)) << invariant.name;
        expected.erase(truth);
      }
      EXPECT_TRUE(expected.empty()) << name_of(curve_class) << ": " << expected.begin()->first;
      EXPECT_EQ(result.pooled, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
    }
  }
}

TEST(RecognitionTree, RecognisesEveryClassFromFiveExactPoints) {
  auto rng = test::test_rng();
  const int cases = test::stress_count(100);
  for (const CurveClass curve_class : test::invariant_classes()) {
    int right = 0;
    for (int i = 0; i < cases; ++i) {
      const auto [curve, result] = walk_exactly(curve_class, rng);
      if (result.shape.curve_class != curve_class) {
        continue;
      }
      ++right;
      // The floor of 1e-6 is the noise that the tree assumes: parameters to within it, magnified by
      // what the geometry of five points makes of it.
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(result.shape.values[k], curve.parameters[k],
                    5.0 * std::sqrt(result.covariance(k, k)) + 1e-12)
            << name_of(curve_class) << " " << curve.parameters.transpose();
      }
      ASSERT_TRUE(result.world_T_curve.has_value());
      EXPECT_EQ(result.places.size(), 5u);
      EXPECT_EQ(result.status, InvariantStatus::Ok);
    }
    if (test::counts_tell()) {
      EXPECT_GE(right, cases * 97 / 100) << name_of(curve_class);
    }
    RecordProperty(std::string(name_of(curve_class)), right);
  }
}

TEST(RecognitionTree, PoseAndPlacesAreThoseOfTheCurve) {
  auto rng = test::test_rng();
  for (const CurveClass curve_class : test::invariant_classes()) {
    const test::PlacedCurve curve = test::random_curve(curve_class, rng);
    const auto places = test::random_places(curve, 6, rng);
    const auto points = test::exact_points(curve, places, rng);
    const TreeResult result = recognise_by_tree(points);
    ASSERT_EQ(result.shape.curve_class, curve_class) << path_of(result);
    ASSERT_TRUE(result.world_T_curve.has_value());
    // Every touched point must be where pose, shape and place put it: symmetric poses agree there.
    const test::PlacedCurve found{curve_class, result.shape.values, *result.world_T_curve};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const LocalEstimate again =
          test::exact_estimate(found, result.places[i].t, result.places[i].direction);
      EXPECT_LT((again.position - points[i].estimate.position).norm(), 1e-4)
          << name_of(curve_class);
      EXPECT_NEAR(wrap_angle(again.tangent_angle - points[i].estimate.tangent_angle), 0.0, 1e-4);
    }
  }
}

TEST(RecognitionTree, RecognisesLineAndCircle) {
  std::vector<TreePoint> points(5);
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.4 * i;
    TreePoint& point = points[static_cast<std::size_t>(i)];
    point.estimate.position = Vec2(1.0, 2.0) + 0.5 * Vec2(std::cos(angle), std::sin(angle));
    point.estimate.tangent_angle = angle + kPi / 2.0;
    point.estimate.kappa = 2.0;
  }
  const TreeResult circle = recognise_by_tree(points);
  EXPECT_EQ(circle.shape.curve_class, CurveClass::Circle) << path_of(circle);
  EXPECT_NEAR(circle.shape.values[0], 0.5, 1e-6);
  ASSERT_TRUE(circle.world_T_curve.has_value());
  EXPECT_NEAR(circle.world_T_curve->x, 1.0, 1e-6);
  EXPECT_NEAR(circle.world_T_curve->y, 2.0, 1e-6);

  for (int i = 0; i < 5; ++i) {
    TreePoint& point = points[static_cast<std::size_t>(i)];
    point.estimate.position = Vec2(0.0, 1.0) + 0.1 * i * Vec2(std::cos(0.3), std::sin(0.3));
    point.estimate.tangent_angle = 0.3;
    point.estimate.kappa = 1e-4 * (i - 2);
    point.estimate.covariance.diagonal() << 1e-10, 1e-10, 1e-6, 1e-2;
  }
  const TreeResult line = recognise_by_tree(points);
  EXPECT_EQ(line.shape.curve_class, CurveClass::Line) << path_of(line);
  ASSERT_TRUE(line.world_T_curve.has_value());
  EXPECT_NEAR(line.world_T_curve->theta, 0.3, 1e-9);
}

TEST(RecognitionTree, LeavesOtherCurvesUnclassified) {
  // Logarithmic spirals: kappa = 1 / (k s), kappa_s = -1 / (k s^2), angle = ln(s) / k. At k = 1.3
  // no class of the tree has such a semi-signature curve.
  std::vector<TreePoint> points;
  constexpr double kGrowth = 1.3;
  for (const double s : {0.5, 0.8, 1.3, 2.0, 3.0, 4.5}) {
    TreePoint point;
    point.estimate.kappa = 1.0 / (kGrowth * s);
    point.estimate.kappa_s = -1.0 / (kGrowth * s * s);
    point.estimate.tangent_angle = std::log(s) / kGrowth;
    points.push_back(point);
  }
  const TreeResult result = recognise_by_tree(points);
  EXPECT_EQ(result.shape.curve_class, CurveClass::Unclassified) << path_of(result);
  EXPECT_EQ(result.status, InvariantStatus::NotThisClass);
  for (const Decision& decision : result.decisions) {
    EXPECT_TRUE(!decision.passed || decision.test == "Ic1 not zero") << decision.test;
  }
  RecognitionTreeOptions plain;
  plain.relative_tolerance = 0.02;
  EXPECT_EQ(recognise_by_tree(points, plain).shape.curve_class, CurveClass::Unclassified);
}

TEST(RecognitionTree, PlainToleranceRecognisesEveryClass) {
  auto rng = test::test_rng();
  RecognitionTreeOptions options;
  options.relative_tolerance = 1e-3;
  const int cases = test::stress_count(50);
  for (const CurveClass curve_class : test::invariant_classes()) {
    int right = 0;
    for (int i = 0; i < cases; ++i) {
      const test::PlacedCurve curve = test::random_curve(curve_class, rng);
      const auto points = test::exact_points(curve, test::random_places(curve, 4, rng), rng);
      const TreeResult result = recognise_by_tree(points, options);
      right += result.shape.curve_class == curve_class ? 1 : 0;
    }
    if (test::counts_tell()) {
      EXPECT_GE(right, cases * 9 / 10) << name_of(curve_class);
    }
  }
}

TEST(RecognitionTree, SaysWhyItCannot) {
  EXPECT_EQ(recognise_by_tree({}).status, InvariantStatus::TooFewPoints);
  std::vector<TreePoint> points(4);
  points[2].estimate.kappa_s = std::nan("");
  EXPECT_EQ(recognise_by_tree(points).status, InvariantStatus::NotFinite);
  points[2].estimate.kappa_s = 0.0;
  points[1].estimate.position.x() = INFINITY;
  EXPECT_EQ(recognise_by_tree(points).status, InvariantStatus::NotFinite);
}

}  // namespace
}  // namespace palpate
