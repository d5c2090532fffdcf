#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "core/curves/pose2.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "tests/unit/invariants/reference_geometry.h"

namespace palpate {
namespace {

using test::measured;
using test::ReferenceCurve;

/// Roundings between (angle, kappa, kappa_s) and an invariant of one point: sine, cosine, five
/// products and two sums of the largest relative effect.
constexpr double kCubicOperations = 8.0;

template <typename Function>
Propagated<2, 3> invariants_of(const test::ReferencePoint& point, Function&& invariants) {
  return propagate<2, 3>(
      Eigen::Vector3d(point.tangent_angle, point.kappa, point.kappa_s),
      [&](const auto& x) { return invariants(canonical_point(x[0], x[1], x[2])); });
}

template <typename Function>
void expect_constant(CurveClass curve_class, Function&& invariants,
                     const std::function<Eigen::Vector2d(const ReferenceCurve&)>& expected) {
  int within_1e10 = 0;
  int compared = 0;
  for (const ReferenceCurve& curve : test::reference_curves_of(curve_class)) {
    for (const auto& point : curve.points) {
      const auto value = invariants_of(point, invariants);
      const Eigen::Vector2d bound = test::conditioning_bound(
          value, Eigen::Vector3d(point.tangent_angle, point.kappa, point.kappa_s),
          kCubicOperations);
      const Eigen::Vector2d error = value.value - expected(curve);
      EXPECT_LE(std::abs(error[0]), bound[0]) << curve.a << " t " << point.t;
      EXPECT_LE(std::abs(error[1]), bound[1]) << curve.a << " t " << point.t;
      ++compared;
      within_1e10 += std::abs(error[0]) < 1e-10 * std::abs(expected(curve)[0]) &&
                             std::abs(error[1]) < 1e-10 * std::abs(expected(curve)[1])
                         ? 1
                         : 0;
    }
  }
  EXPECT_GE(compared, 60);
  EXPECT_GE(within_1e10, compared * 9 / 10);
}

TEST(CubicalParabolaInvariants, AreConstantAlongEveryReferenceCurve) {
  expect_constant(
      CurveClass::CubicalParabola,
      [](const auto& p) {
        return std::array{cubical_parabola_a(p), cubical_parabola_c(p)};
      },
      [](const ReferenceCurve& curve) { return Eigen::Vector2d(curve.a, curve.c); });
}

TEST(SemiCubicalParabolaInvariants, AreConstantAlongEveryReferenceCurve) {
  expect_constant(
      CurveClass::SemiCubicalParabola,
      [](const auto& p) {
        return std::array{semi_cubical_parabola_a_squared(p), semi_cubical_parabola_b(p)};
      },
      [](const ReferenceCurve& curve) { return Eigen::Vector2d(curve.a * curve.a, curve.b); });
}

/// One of the two families, for the error bound of a pair.
struct Family {
  PairSolutions (*solve)(const MeasuredGeometry&, const MeasuredGeometry&);
  AngleQuadratic<double> (*quadratic)(const double&, const double&, const double&, const double&,
                                      const double&);
  std::function<Eigen::Vector2d(const ReferenceCurve&)> truth;
  std::function<Propagated<2, 3>(const Eigen::Vector3d&)>
      parameters;  ///< of (angle, kappa, kappa_s)
};

/// Each coefficient of the quadratic is a sum of products whose sizes add up to at most ten times
/// (|kappa_s1| + kappa1^2)(|kappa_s2| + kappa2^2); rounding and the inputs' own errors change it by
/// kCubicOperations epsilon of that, the angle by this over the quadratic's slope at the root, and
/// the parameters by their derivative with respect to the angle.
Eigen::Vector2d pair_bound(const Family& family, const test::ReferencePoint& p1,
                           const test::ReferencePoint& p2) {
  const auto q = family.quadratic(p1.kappa, p1.kappa_s, p2.kappa, p2.kappa_s,
                                  p2.tangent_angle - p1.tangent_angle);
  const double terms = 10.0 * (std::abs(p1.kappa_s) + p1.kappa * p1.kappa) *
                       (std::abs(p2.kappa_s) + p2.kappa * p2.kappa);
  const double sine2 = std::sin(2.0 * p1.tangent_angle);
  const double cosine2 = std::cos(2.0 * p1.tangent_angle);
  const double slope = std::abs((q.q2 - q.q0) * sine2 + q.q1 * cosine2);
  const double angle_error = kCubicOperations * test::kEpsilon * terms / slope;
  const Eigen::Vector3d inputs(p1.tangent_angle, p1.kappa, p1.kappa_s);
  const auto linear = family.parameters(inputs);
  return linear.jacobian.col(0).cwiseAbs() * angle_error +
         test::conditioning_bound(linear, inputs, kCubicOperations);
}

/// Every pair of points of every curve of the class whose conditioning leaves nine digits.
void expect_pairs_recover(CurveClass curve_class, const Family& family) {
  int compared = 0;
  for (const ReferenceCurve& curve : test::reference_curves_of(curve_class)) {
    const Eigen::Vector2d truth = family.truth(curve);
    for (const auto& point1 : curve.points) {
      for (const auto& point2 : curve.points) {
        const Eigen::Vector2d bound = pair_bound(family, point1, point2);
        if (!((bound.array() < 1e-9 * truth.array().abs()).all())) {
          continue;
        }
        const PairSolutions solutions = family.solve(measured(point1), measured(point2));
        ASSERT_EQ(solutions.status, InvariantStatus::Ok);
        const PairSolution& best = solutions.solutions[0];
        EXPECT_LE(std::abs(best.parameters[0] - truth[0]), bound[0])
            << truth.transpose() << " t " << point1.t << " " << point2.t << " mismatch "
            << best.mismatch;
        EXPECT_LE(std::abs(best.parameters[1] - truth[1]), bound[1]);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 400);
}

TEST(CubicalParabolaInvariants, PairsRecoverEveryReferenceCurve) {
  expect_pairs_recover(
      CurveClass::CubicalParabola,
      {cubical_parabola_pair, cubical_parabola_quadratic<double>,
       [](const ReferenceCurve& curve) { return Eigen::Vector2d(curve.a, curve.c); },
       [](const Eigen::Vector3d& inputs) {
         return propagate<2, 3>(inputs, [](const auto& x) {
           const auto p = canonical_point(x[0], x[1], x[2]);
           return std::array{cubical_parabola_a(p), cubical_parabola_c(p)};
         });
       }});
}

TEST(SemiCubicalParabolaInvariants, PairsRecoverEveryReferenceCurve) {
  expect_pairs_recover(
      CurveClass::SemiCubicalParabola,
      {semi_cubical_parabola_pair, semi_cubical_parabola_quadratic<double>,
       [](const ReferenceCurve& curve) { return Eigen::Vector2d(curve.a, curve.b); },
       [](const Eigen::Vector3d& inputs) {
         return propagate<2, 3>(inputs, [](const auto& x) {
           const auto p = canonical_point(x[0], x[1], x[2]);
           return std::array{sqrt(semi_cubical_parabola_a_squared(p)), semi_cubical_parabola_b(p)};
         });
       }});
}

}  // namespace
}  // namespace palpate
