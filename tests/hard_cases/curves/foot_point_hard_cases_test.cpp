// Foot points in hard cases: on evolutes, far away, at every size, next to a cusp, on slender
// ellipses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/curves/curve.h"

namespace palpate {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(FootPointHardCases, CentresOfCurvature) {
  // The squared distance is flat to third order (fourth at a vertex): t is known to the cube
  // (fourth) root of rounding, the distance to rounding.
  for (const CurveClass curve_class : kCurveClasses) {
    if (curve_class == CurveClass::Line) {
      continue;
    }
    const Curve curve = *make_curve(curve_class, {2.0, 0.9, 0.5});
    for (const double t : {0.0, 0.01, 0.4, 1.2, -0.9}) {
      const LocalGeometry g = geometry(curve, t);
      if (g.kappa == 0.0 || std::isinf(g.kappa)) {
        continue;
      }
      const Vec2 normal = left_of(derivatives(curve, t).first).normalized();
      const Vec2 centre = position(curve, t) + normal / g.kappa;
      const double rounding =
          16.0 * kEpsilon * (centre.norm() + position(curve, t).norm() + 1.0 / std::abs(g.kappa));
      for (const FootPoint& foot : {foot_point(curve, centre), foot_point_near(curve, centre, t)}) {
        EXPECT_LE(std::abs(foot.distance), 1.0 / std::abs(g.kappa) + rounding)
            << name_of(curve_class) << " " << t;
        EXPECT_NEAR((centre - foot.position).norm(), std::abs(foot.distance), rounding);
      }
    }
  }
}

TEST(FootPointHardCases, VerticesSeenFromTheCuspOfTheEvolute) {
  EXPECT_NEAR((Ellipse{2.0, 1.0}).foot_point({1.5, 0.0}).distance, 0.5, 1e-15);
  EXPECT_NEAR(Parabola{1.0}.foot_point({2.0, 0.0}).distance, -2.0, 1e-15);
  EXPECT_NEAR((Hyperbola{3.0, 4.0}).foot_point({25.0 / 3.0, 0.0}).distance, -16.0 / 3.0, 1e-14);
  // And just off the axis, where the root is nearly triple.
  for (const double y : {1e-3, 1e-9, 1e-15, 1e-300}) {
    EXPECT_NEAR((Ellipse{2.0, 1.0}).foot_point({1.5, y}).distance, 0.5, y + 1e-15);
    EXPECT_NEAR(Parabola{1.0}.foot_point({2.0, -y}).distance, -2.0, y + 1e-15);
    EXPECT_NEAR((Hyperbola{3.0, 4.0}).foot_point({25.0 / 3.0, y}).distance, -16.0 / 3.0, y + 1e-14);
  }
}

TEST(FootPointHardCases, SlenderAndRoundEllipses) {
  for (const double ratio : {1.0, 1.0 + 1e-15, 1.0 + 1e-7, 100.0, 1e4}) {
    const Ellipse ellipse{ratio, 1.0};
    for (const double t : {0.0, 1e-9, 1e-3, 0.5, 1.5, 0.5 * kPi, 3.1, -2.0, -1e-5}) {
      const CurveDerivatives d = ellipse.derivatives(t);
      const Vec2 normal = left_of(d.first).normalized();
      // Inside by half the smallest radius; outside by as much, and by far more.
      const double radius = 1.0 / ratio;
      for (const double offset : {0.5 * radius, -0.5 * radius, -1.0, -1e3}) {
        const FootPoint foot = ellipse.foot_point(d.position + offset * normal);
        // The rounding of the point itself, and of sin t next to t = pi.
        const double rounding = 8.0 * kEpsilon * (ratio + std::abs(offset));
        EXPECT_NEAR(foot.distance, offset, rounding) << ratio << " " << t;
        EXPECT_LE((foot.position - d.position).norm(), 2.0 * rounding) << ratio << " " << t;
      }
    }
  }
}

TEST(FootPointHardCases, FarAwayPoints) {
  for (const CurveClass curve_class : kCurveClasses) {
    const Curve curve = *make_curve(curve_class, {1.0, 0.5, 0.3});
    for (const double far : {1e3, 1e6, 1e9}) {
      for (int i = 0; i < 16; ++i) {
        const double angle = kPi * i / 8.0 + 0.01;
        const Vec2 point = far * Vec2(std::cos(angle), std::sin(angle));
        const FootPoint foot = foot_point(curve, point);
        ASSERT_TRUE(std::isfinite(foot.t)) << name_of(curve_class);
        // Perpendicular to rounding of the coordinates, or at a cusp; and no farther than the
        // origin.
        const Vec2 tangent = derivatives(curve, foot.t).first;
        const double along = std::abs((point - foot.position).dot(tangent));
        EXPECT_LE(along,
                  16.0 * kEpsilon * (far + foot.position.norm()) * tangent.norm() +
                      4.0 * kEpsilon * std::abs(foot.t) *
                          (tangent.squaredNorm() + far * derivatives(curve, foot.t).second.norm()))
            << name_of(curve_class) << " " << point.transpose() << " t " << foot.t;
        EXPECT_LE(std::abs(foot.distance),
                  (point - position(curve, 0.0)).norm() * (1.0 + 4.0 * kEpsilon));
      }
    }
  }
}

TEST(FootPointHardCases, AnywhereNextToACusp) {
  const SemiCubicalParabola cusp{1.2, -0.8};
  for (const double t : {1e-2, 1e-4, 1e-6, -1e-3, -1e-5}) {
    // Half the radius to the left, which is outside: the foot point is on the same arm.
    const CurveDerivatives d = cusp.derivatives(t);
    const double offset = 0.5 / cusp.geometry(t).kappa;
    const Vec2 outside = d.position - offset * left_of(d.first).normalized();
    const FootPoint foot = cusp.foot_point(outside);
    EXPECT_LE(std::abs(foot.distance), offset * (1.0 + 1e-9)) << t;
    const FootPoint on = cusp.foot_point(d.position);
    EXPECT_LE(std::abs(on.distance), 4.0 * kEpsilon * d.position.norm()) << t;
    EXPECT_NEAR(on.t / t, 1.0, 1e-7) << t;
  }
  EXPECT_EQ(cusp.foot_point({0.0, 0.0}).t, 0.0);
  EXPECT_EQ(cusp.foot_point({0.0, 0.0}).distance, 0.0);
}

TEST(FootPointHardCases, SplineThatIsAllButACuspHasTheFeetOfTheCusp) {
  const SemiCubicalParabola cusp{1.5, 0.4};
  for (const double c : {1e-3, -1e-3, 1e-6, -1e-9, 1e-15, 1e-100}) {
    const CubicSpline spline{1.5, 0.4, c};
    for (int i = 0; i < 64; ++i) {
      const double angle = kPi * i / 32.0 + 0.003;
      const Vec2 point = 0.3 * Vec2(std::cos(angle), std::sin(angle));
      const FootPoint foot = spline.foot_point(point);
      const FootPoint limit = cusp.foot_point(point);
      // The curves are |c t| apart in y, with t of a foot point, and a distance changes by no more
      // than the curve moves.
      const double apart = std::abs(c) * std::max(std::abs(foot.t), std::abs(limit.t));
      EXPECT_NEAR(std::abs(foot.distance), std::abs(limit.distance), apart + 1e-15)
          << c << " " << angle;
    }
  }
}

}  // namespace
}  // namespace palpate
