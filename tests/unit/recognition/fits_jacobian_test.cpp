// The fits' distances and their derivatives.
#include <gtest/gtest.h>

#include <cmath>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/orthogonal/implicit_fit.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/fit/starts/algebraic_fit.h"
#include "core/recognition/smooth/smooth_model.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

TEST(ImplicitFit, SignedDistanceToACircle) {
  ConicCoefficients q;
  q << 1.0, 0.0, 1.0, 0.0, 0.0, -4.0;
  Vec2 foot;
  EXPECT_NEAR(signed_distance(q, {3.0, 0.0}, &foot), 1.0, 1e-12);
  EXPECT_NEAR(signed_distance(q, {0.0, 1.9}, &foot), -0.1, 1e-12);
  EXPECT_NEAR((foot - Vec2(0.0, 2.0)).norm(), 0.0, 1e-12);
}

TEST(ImplicitFit, ATipAboutTheCentreOfAHyperbolaKeepsItsBranch) {
  // About the centre the polynomial is flat: its first-order foot may be anywhere.
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(20000); ++i) {
    const double a = test::log_uniform(rng, 0.06, 1.0);
    const double b = test::log_uniform(rng, 0.06, 1.0);
    const double t = test::uniform(rng, -1.7, 1.7);
    const double radius = a * test::uniform(rng, 0.1, 3.0);
    ConicCoefficients q;
    q << 1.0 / (a * a), 0.0, -1.0 / (b * b), 0.0, 0.0, -1.0;
    q.normalize();
    const Vec2 touched(a * std::cosh(t), b * std::sinh(t));
    const Vec2 centre = touched - radius * conic_gradient(q, touched).normalized();
    const double nearby = t + test::uniform(rng, -0.1, 0.1);
    Vec2 foot;
    WorkBudget work;
    const double distance = signed_distance_of_tip({a * std::cosh(nearby), b * std::sinh(nearby)},
                                                   q, centre, &foot, work);
    // Newton's method ends where a step is less than 1e-12 or 1e-4 of the root of the distance.
    EXPECT_NEAR(distance, -radius, 1e-7 * radius) << a << ' ' << b << ' ' << t;
    EXPECT_LT((foot - touched).norm(), 1e-4 * radius) << a << ' ' << b << ' ' << t;
  }
}

TEST(ImplicitFit, ATipInABoreTouchesTheWallBesideItsNeighbour) {
  // Its centre has up to four feet, and about the bore's centre the first-order foot may be any.
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(20000); ++i) {
    const double a = test::log_uniform(rng, 0.1, 1.0);
    const double b = a * test::uniform(rng, 0.3, 1.0);
    const double t = test::uniform(rng, -kPi, kPi);
    const Vec2 touched(a * std::cos(t), b * std::sin(t));
    const double speed = std::hypot(a * std::sin(t), b * std::cos(t));
    const double radius = test::uniform(rng, 0.1, 0.97) * std::pow(speed, 3) / (a * b);
    ConicCoefficients q;
    q << 1.0 / (a * a), 0.0, 1.0 / (b * b), 0.0, 0.0, -1.0;
    q.normalize();
    const Vec2 centre = touched - radius * conic_gradient(q, touched).normalized();
    const double nearby = t + test::uniform(rng, -0.01, 0.01);
    Vec2 foot;
    WorkBudget work;
    const double distance = signed_distance_of_tip({a * std::cos(nearby), b * std::sin(nearby)}, q,
                                                   centre, &foot, work);
    EXPECT_NEAR(distance, -radius, 1e-7 * radius) << a << ' ' << b << ' ' << t;
    EXPECT_LT((foot - touched).norm(), 1e-4 * radius) << a << ' ' << b << ' ' << t;
  }
}

TEST(ImplicitFit, ExactPointsAreFittedExactly) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.sigma_over_size = 0.0;
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    for (int i = 0; i < 50; ++i) {
      const test::Scene scene = test::random_scene(curve_class, options, rng);
      const FitData data = test::fit_data(scene, 1e-9);
      const ImplicitFit fit =
          refine_conic(data.points, algebraic_conic(data.points), 0, {}, test::unbounded_work());
      // 222 points, residuals in units of 1e-9 m: rounding of 1e-16 of positions ten sizes away.
      EXPECT_LT(fit.chi2, 222.0 * 1e-10);
    }
  }
}

TEST(PolynomialFit, RefinementFindsExactCurvesFromTheSearch) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.sigma_over_size = 0.0;
  int found = 0;
  int scenes = 0;
  for (const CurveClass curve_class : {CurveClass::Parabola, CurveClass::CubicalParabola,
                                       CurveClass::SemiCubicalParabola, CurveClass::CubicSpline}) {
    for (int i = 0; i < 25; ++i) {
      const test::Scene scene = test::random_scene(curve_class, options, rng);
      FitData data = test::fit_data(scene, 1e-6);
      const SmoothModel smooth = fit_smooth_model(&data, true);
      const ClassFits fits = fit_classes(smooth.reduced, test::unbounded_work());
      const auto& fit = fits[static_cast<std::size_t>(curve_class)];
      ASSERT_TRUE(fit.has_value());
      const auto refined =
          refine_on_all(settled(*fit, smooth.reduced, RivalOf::Best, test::unbounded_work()),
                        smooth, data, kOnAllEffort, test::unbounded_work());
      ++scenes;
      // Less than a thousandth of sigma = 1e-6 m off, root mean square.
      found += refined && refined->chi2 < 222.0 * 1e-6 ? 1 : 0;
    }
  }
  // A spline round a needle-sharp bend may be missed: at most one in fifty.
  EXPECT_GE(found, scenes - scenes / 50);
}

TEST(PolynomialFit, InformationMatchesFiniteDifferencesOfTheResiduals) {
  // The envelope theorem: at the optimum the information predicts how chi2 rises when coefficients
  // move with foot points following.
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  const test::Scene scene = test::random_scene(CurveClass::Parabola, options, rng);
  FitData data = test::fit_data(scene, scene.sigma_m);
  const SmoothModel smooth = fit_smooth_model(&data, true);
  const ClassFits fits = fit_classes(smooth.reduced, test::unbounded_work());
  const auto refined = refine_on_all(settled(*fits[static_cast<std::size_t>(CurveClass::Parabola)],
                                             smooth.reduced, RivalOf::Best, test::unbounded_work()),
                                     smooth, data, kOnAllEffort, test::unbounded_work());
  ASSERT_TRUE(refined.has_value());
  const PolynomialFit& fit = *refined->polynomial;
  const auto chi2_of = [&](const PolynomialCoefficients& c) {
    PolynomialFit moved = fit;
    moved.coefficients = c;
    double sum = 0.0;
    for (std::size_t i = 0; i < data.points.size(); ++i) {
      const PlacedPoint placed = place_on(moved, fit.t[i], data.points[i]);
      sum += std::pow(placed.signed_distance * data.points[i].inverse_sigma, 2);
    }
    return sum;
  };
  const double at_optimum = chi2_of(fit.coefficients);
  EXPECT_NEAR(at_optimum, fit.chi2, 1e-6 * fit.chi2);
  // A translation by one standard error of the mean along x raises chi2 by sum cos^2 / n.
  for (int axis = 0; axis < 2; ++axis) {
    PolynomialCoefficients moved = fit.coefficients;
    const double step = 1.0 / (data.points.front().inverse_sigma * std::sqrt(222.0));
    moved(axis, 0) += step;
    double predicted = 0.0;
    for (std::size_t i = 0; i < data.points.size(); ++i) {
      const Vec2 normal = place_on(fit, fit.t[i], data.points[i]).normal;
      predicted += std::pow(normal[axis] * step * data.points[i].inverse_sigma, 2);
    }
    PolynomialCoefficients opposite = fit.coefficients;
    opposite(axis, 0) -= step;
    const double rise = 0.5 * (chi2_of(moved) + chi2_of(opposite)) - at_optimum;
    EXPECT_NEAR(rise, predicted, 0.02 * predicted + 1e-6);
  }
}

}  // namespace
}  // namespace palpate
