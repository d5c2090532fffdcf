// What is said to lie at the limit of its class does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/length_powers.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/given_limit.h"
#include "core/recognition/given/given_search.h"
#include "core/recognition/given/local_points.h"
#include "core/recognition/given/parallel_lines.h"
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

/// Least chi-square of two parallel lines, by the search.
double chi2_of_parallels(const std::vector<GivenPoint>& points) {
  const LocalPoints local = *local_points(points, 0.0, true);
  double sum = misfit_of_parallels(local, {points, 0.0, true});
  for (const auto& point : local.exact) {
    sum += std::log(to_double(point.weight));
  }
  return 2.0 * sum;
}

/// Two walls through `middle`, of half the length `half_length` and so far apart, along
/// `direction`.
struct Walls {
  Vec2 middle;
  Vec2 direction;  ///< unit
  double half_length = 0.0;
  double apart = 0.0;
};

/// `touches` on either wall, off it by what `error(i)` says for number i.
template <typename Error>
std::vector<GivenPoint> touched(const Walls& walls, int touches, double sigma, const Error& error) {
  std::vector<GivenPoint> points;
  for (int i = 0; i < 2 * touches; ++i) {
    const double along = -1.0 + 2.0 * (i / 2) / (touches - 1.0);
    GivenPoint& point = points.emplace_back();
    point.position_m =
        walls.middle + along * walls.half_length * walls.direction +
        ((i % 2 == 0 ? 0.5 : -0.5) * walls.apart + error(i)) * left_of(walls.direction);
    point.sigma_m = sigma;
  }
  return points;
}

// With the touches of either wall known, the lines' direction is that in which the touches scatter
// least about the mean of their wall, summed over both.
TEST(ParallelLines, FitAsBothWallsTogether) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int scene = 0; scene < test::stress_count(40); ++scene) {
    const double angle = kPi * uniform(rng);
    const Walls walls{Vec2(uniform(rng), uniform(rng)), Vec2(std::cos(angle), std::sin(angle)),
                      0.05, test::log_uniform(rng, 0.002, 0.2)};
    const double sigma = walls.apart * test::log_uniform(rng, 1e-4, 2e-2);
    const int touches = 3 + scene % 30;
    const auto points = touched(walls, touches, sigma, [&](int) { return sigma * normal(rng); });
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const std::size_t wall : {0U, 1U}) {
      Vec2 mean = Vec2::Zero();
      for (std::size_t i = wall; i < points.size(); i += 2) {
        mean += points[i].position_m / touches;
      }
      for (std::size_t i = wall; i < points.size(); i += 2) {
        const Vec2 off = points[i].position_m - mean;
        scatter += off * off.transpose() / (sigma * sigma);
      }
    }
    const double half_trace = 0.5 * scatter.trace();
    const double least = scatter.determinant() /
                         (half_trace + std::sqrt(half_trace * half_trace - scatter.determinant()));
    EXPECT_NEAR(chi2_of_parallels(points), least, 1e-6 * (1.0 + least)) << "scene " << scene;
  }
}

/// Two walls 40 mm apart, and errors of a thousandth of their half length, none of which turns or
/// bends a wall much.
std::vector<GivenPoint> straight_walls() {
  constexpr double kSigma = 5e-5;
  return touched({Vec2(0.3, -0.1), Vec2(0.6, 0.8), 0.05, 0.04}, 20, kSigma,
                 [](int i) { return kSigma * (i % 4 < 2 ? 1.0 : -1.0); });
}

// The vertex moves away from the walls for as long as anybody follows.
TEST(GivenLimit, TwoParallelWallsAreTheLimitOfParabolaAndHyperbola) {
  for (const double tip_radius : {0.0, 0.002}) {
    std::vector<GivenPoint> points = straight_walls();
    for (GivenPoint& point : points) point.tip_radius_m = tip_radius;
    for (const CurveClass curve_class : {CurveClass::Parabola, CurveClass::Hyperbola}) {
      const GivenFit fit = fit_given_class(curve_class, points);
      EXPECT_EQ(name_of(fit.status), name_of(GivenStatus::AtLimit))
          << name_of(curve_class) << ", tips of " << tip_radius;
    }
  }
}

// A little bent, the walls are best a long ellipse: better than at any limit, but far away.
TEST(GivenLimit, AMinimumFarDownAValleyIsUnfinished) {
  constexpr double kSigma = 5e-5;
  const auto points = touched({Vec2(0.0, 0.0), Vec2(1.0, 0.0), 0.05, 0.04}, 20, kSigma, [](int i) {
    return kSigma * std::sin(9 * (i / 2) + (i % 2 == 0 ? 1 : -1));
  });
  const GivenFit fit = fit_given_class(CurveClass::Ellipse, points);
  EXPECT_EQ(name_of(fit.status), name_of(GivenStatus::Unfinished));
  const LocalPoints local = *local_points(points, 0.0, true);
  const GivenNoise noise{points, 0.0, true};
  const double limit = misfit_of_limit(CurveClass::Ellipse, local, noise);
  EXPECT_LT(search_minima(CurveClass::Ellipse, local, noise).front().misfit, limit - kAlike);
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
            std::min({chi2_of(CurveClass::Parabola, points), chi2_of(CurveClass::Line, points),
                      chi2_of_parallels(points)});
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
