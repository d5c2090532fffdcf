// What is said to lie at the limit of its class does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/length_powers.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/given_search.h"
#include "core/recognition/given/local_points.h"
#include "tests/support/random_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

std::vector<GivenPoint> touches_of(const test::Scene& scene) {
  std::vector<GivenPoint> points;
  for (const auto& patch : scene.patches) {
    for (const Vec2& place : patch) {
      GivenPoint& point = points.emplace_back();
      point.position_m = place;
      point.sigma_m = scene.sigma_m;
    }
  }
  return points;
}

/// Chi-square of the minimum that a long descent from the true curve ends at; infinite if it does
/// not end.
double least_from_truth(const test::Scene& scene, const std::vector<GivenPoint>& points) {
  const LocalPoints local = *local_points(points, 0.0, true);
  GivenCandidate truth;
  truth.curve.curve_class = scene.curve_class;
  const Eigen::Vector3d powers = length_powers(scene.curve_class);
  for (int i = 0; i < 3; ++i) {
    truth.curve.shape[i] = scene.values[i] / std::pow(local.unit_m, powers[i]);
  }
  const Vec2 origin = (scene.world_T_curve.translation() - local.middle_m) / local.unit_m;
  truth.curve.origin = {origin.x(), origin.y()};
  truth.curve.axis = {std::cos(scene.world_T_curve.theta), std::sin(scene.world_T_curve.theta)};
  settle(local, {points, 0.0, true}, &truth);
  constexpr DescentEffort kLong{3000, 1e-8, 0.0};
  descend_on(truth.points, kLong, &truth);
  return truth.settled ? 2.0 * truth.cost : std::numeric_limits<double>::infinity();
}

double chi2_of(CurveClass curve_class, const std::vector<GivenPoint>& points) {
  const GivenFit fit = fit_given_class(curve_class, points);
  return fit.status == GivenStatus::Fitted ? fit.chi2 : std::numeric_limits<double>::infinity();
}

// A descent that has merely not come to its end is no limit.
TEST(GivenLimit, IsSaidOnlyWhereItFitsBest) {
  auto rng = test::test_rng();
  int at_limit = 0;
  const int scenes = test::stress_count(90);
  for (const CurveClass curve_class : {CurveClass::Hyperbola, CurveClass::CubicalParabola}) {
    SCOPED_TRACE(name_of(curve_class));
    for (int i = 0; i < scenes; ++i) {
      test::SceneOptions options;
      options.patches = 1 + i % 2;
      options.points_per_patch = 40;
      options.sigma_over_size = test::log_uniform(rng, 0.003, 0.01);
      const test::Scene scene = test::random_scene(curve_class, options, rng);
      const std::vector<GivenPoint> points = touches_of(scene);
      const GivenFit fit = fit_given_class(curve_class, points);
      EXPECT_NE(fit.status, GivenStatus::NotFinite);
      if (fit.status == GivenStatus::AtLimit) {
        ++at_limit;
        const double of_limit =
            std::min(chi2_of(CurveClass::Parabola, points), chi2_of(CurveClass::Line, points));
        if (std::isfinite(of_limit)) {
          EXPECT_GE(least_from_truth(scene, points), of_limit - 1e-5) << "scene " << i;
        }
      }
    }
  }
  if (test::counts_tell()) {
    EXPECT_GT(at_limit, 0);
  }
}

}  // namespace
}  // namespace palpate
