// How far the shape of a given class can be moved: the same of few touches and of many.
#include "core/recognition/given/given_reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/verdict/determined.h"
#include "tests/support/calibration.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct Arc {
  Curve curve;
  double from = 0.0;
  double to = 0.0;
  double sigma_m = 1e-5;
};

/// Short arcs: their valleys are so bent that a linear covariance is far too small.
std::vector<Arc> short_arcs(int count, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Arc> arcs;
  for (int i = 0; i < count; ++i) {
    const double from = 2.0 * kPi * uniform(rng);
    arcs.push_back({Ellipse{0.03, 0.03 * (0.3 + 0.5 * uniform(rng))}, from, from + 1.0, 5e-5});
    arcs.push_back({CubicalParabola{300.0 + 300.0 * uniform(rng), 0.3}, -0.01, 0.03, 1e-4});
  }
  return arcs;
}

std::vector<GivenPoint> touches_of(const Arc& arc, int count, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const Pose2 pose{0.3, -0.2, 0.7};
  std::vector<GivenPoint> points;
  for (int i = 0; i < count; ++i) {
    const double t = arc.from + (arc.to - arc.from) * (i + 0.5) / count;
    GivenPoint& point = points.emplace_back();
    point.position_m =
        pose * (position(arc.curve, t) + arc.sigma_m * Vec2(normal(rng), normal(rng)));
    point.sigma_m = arc.sigma_m;
  }
  return points;
}

/// Largest ratio of the two fits' deviations of a shape parameter, either way.
double ratio_of_deviations(const GivenFit& u, const GivenFit& v) {
  double ratio = 1.0;
  const auto shape = u.covariance.rows() - 3;
  for (Eigen::Index i = 0; i < shape; ++i) {
    const double one = std::sqrt(u.covariance(i, i) / v.covariance(i, i));
    ratio = std::max({ratio, one, 1.0 / one});
  }
  return ratio;
}

/// Whether the shape is told to a tenth of its size. Of one that is less known, chi-square may rise
/// towards the end of the class by hardly more than what is asked: then its deviations depend on
/// every touch.
bool tells(const GivenFit& fit) {
  return fit.status == GivenStatus::Fitted && fit.bounded &&
         is_determined(fit.shape, fit.covariance, 0.02, 0.1);
}

// A touch of a given noise says the same as two there of sqrt(2) of that noise.
TEST(GivenReach, TwoTouchesSayWhatOneOfHalfTheVarianceSays) {
  auto rng = test::test_rng();
  int told = 0;
  int scenes = 0;
  for (const Arc& arc : short_arcs(test::stress_count(12), rng)) {
    SCOPED_TRACE(name_of(class_of(arc.curve)));
    const std::vector<GivenPoint> once = touches_of(arc, 256, rng);
    std::vector<GivenPoint> twice;
    for (GivenPoint point : once) {
      point.sigma_m *= std::sqrt(2.0);
      twice.insert(twice.end(), {point, point});
    }
    std::shuffle(twice.begin(), twice.end(), rng);
    const GivenFit of_once = fit_given_class(class_of(arc.curve), once);
    const GivenFit of_twice = fit_given_class(class_of(arc.curve), twice);
    ++scenes;
    // Of several minima the search may take different ones.
    if ((tells(of_once) || tells(of_twice)) && std::abs(of_once.chi2 - of_twice.chi2) < 1e-6) {
      ++told;
      EXPECT_EQ(of_once.bounded, of_twice.bounded);
      // The walks are the same to the last step of their descents, 1e-4 of the reach.
      EXPECT_LT(ratio_of_deviations(of_once, of_twice), 1.001);
    }
  }
  if (test::counts_tell()) {
    EXPECT_GT(told, scenes / 10);
    EXPECT_LT(told, scenes);  // or there has been no wide valley
  }
}

// Two touches of 257 know, of any parameter, 2 / 257 on average, and no more than some times that.
TEST(GivenReach, TwoTouchesOfManyChangeLittle) {
  auto rng = test::test_rng();
  int told = 0;
  int scenes = 0;
  for (const Arc& arc : short_arcs(test::stress_count(12), rng)) {
    SCOPED_TRACE(name_of(class_of(arc.curve)));
    std::vector<GivenPoint> points = touches_of(arc, 257, rng);
    const GivenFit all = fit_given_class(class_of(arc.curve), points);
    points.erase(points.begin() + 150);
    points.erase(points.begin() + 100);
    const GivenFit fewer = fit_given_class(class_of(arc.curve), points);
    ++scenes;
    if (tells(all) || tells(fewer)) {
      ++told;
      EXPECT_EQ(all.bounded, fewer.bounded);
      EXPECT_LT(ratio_of_deviations(all, fewer), kAlikeDeviations);
    }
  }
  if (test::counts_tell()) {
    EXPECT_GT(told, scenes / 10);
  }
}

// If noise alone can have made the circle an ellipse, it can have turned it any way.
TEST(GivenReach, TheDirectionOfANearCircleIsNoSurerThanItsOvality) {
  auto rng = test::test_rng();
  const Arc ring{Ellipse{0.03, 0.029997}, 0.0, 2.0 * kPi, 3e-5};
  // An ovality is two numbers, here a few tenths of a deviation off 0. Further than three
  // deviations off, the covariance holds to first order.
  const double further = std::exp(-0.5 * kReach * kReach);
  std::vector<double> probabilities;
  int surer = 0;
  const int scenes = test::stress_count(300);
  for (int i = 0; i < scenes; ++i) {
    const GivenFit fit = fit_given_class(CurveClass::Ellipse, touches_of(ring, 60, rng));
    ASSERT_EQ(fit.status, GivenStatus::Fitted);
    const double error = std::remainder(fit.world_T_curve.theta - 0.7, kPi);
    surer += std::abs(error) > kReach * std::sqrt(fit.covariance(4, 4)) ? 1 : 0;
    probabilities.push_back(further);
  }
  EXPECT_LE(surer, test::binomial_band(probabilities, 1.0 - 2e-4).most);
}

}  // namespace
}  // namespace palpate
