// Offset curves taken back to the surface, against the curves' own geometry.
#include "core/local/tip_radius.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

/// The tip's centre at t of a curve, by its definition.
Vec2 centre_at(const Curve& curve, double t, double offset) {
  const double angle = geometry(curve, t).tangent_angle;
  return position(curve, t) + offset * Vec2(-std::sin(angle), std::cos(angle));
}

TEST(TipRadius, OffsetCurvatureAgainstDifferences) {
  for (const test::TouchedArc& arc : test::touched_arcs()) {
    for (const double offset : {0.003, -0.003}) {
      const LocalGeometry at = geometry(arc.curve, arc.centre_t);
      LocalEstimate surface;
      surface.position = position(arc.curve, arc.centre_t);
      surface.tangent_angle = at.tangent_angle;
      surface.kappa = at.kappa;
      surface.kappa_s = at.kappa_s;
      const auto centre = surface_from_tip(surface, -offset);
      ASSERT_TRUE(centre.has_value()) << arc.name;
      EXPECT_LT((centre->position - centre_at(arc.curve, arc.centre_t, offset)).norm(), 1e-15);
      // Curvature of the centres by tangent angle over arc length between two near places.
      const double step = 1e-6;
      const double t0 = parameter_at_arc_length(arc.curve, arc.centre_t, -step);
      const double t1 = parameter_at_arc_length(arc.curve, arc.centre_t, step);
      const double chord =
          (centre_at(arc.curve, t1, offset) - centre_at(arc.curve, t0, offset)).norm();
      const double turn =
          wrap_angle(geometry(arc.curve, t1).tangent_angle - geometry(arc.curve, t0).tangent_angle);
      // Angles rounded to 1e-16 over 2e-6 m; truncation 1e-12 kappa_ss.
      EXPECT_NEAR(centre->kappa, turn / chord, 1e-8 * (1.0 + std::abs(at.kappa))) << arc.name;
      const double kappa0 =
          geometry(arc.curve, t0).kappa / (1.0 - offset * geometry(arc.curve, t0).kappa);
      const double kappa1 =
          geometry(arc.curve, t1).kappa / (1.0 - offset * geometry(arc.curve, t1).kappa);
      EXPECT_NEAR(centre->kappa_s, (kappa1 - kappa0) / chord,
                  1e-7 * (1.0 + std::abs(centre->kappa_s)))
          << arc.name;
    }
  }
}

TEST(TipRadius, ThereAndBack) {
  LocalEstimate surface;
  surface.position = {0.1, -0.2};
  surface.tangent_angle = 2.0;
  surface.kappa = -30.0;
  surface.kappa_s = 700.0;
  surface.window_arc_m = 0.02;
  surface.covariance = Eigen::Vector4d(1e-10, 1e-6, 0.1, 1e3).asDiagonal();
  surface.covariance(0, 2) = surface.covariance(2, 0) = 1e-6;
  for (const double offset : {0.004, -0.004}) {
    const auto centre = surface_from_tip(surface, -offset);
    ASSERT_TRUE(centre.has_value());
    const auto back = surface_from_tip(*centre, offset);
    ASSERT_TRUE(back.has_value());
    EXPECT_LT((back->position - surface.position).norm(), 1e-15);
    EXPECT_NEAR(back->kappa, surface.kappa, 1e-13 * 30.0);
    EXPECT_NEAR(back->kappa_s, surface.kappa_s, 1e-13 * 700.0);
    EXPECT_NEAR(back->window_arc_m, surface.window_arc_m, 1e-15);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const double size = std::sqrt(surface.covariance(i, i) * surface.covariance(j, j));
        // kappa_s lacks the term of kappa_ss, which the offset curve has even where the surface
        // has none: 3 d kappa_s^2, times d, times the error of the angle.
        const double left_out =
            i < 3 && j < 3 ? 0.0 : 2.0 * 3.0 * std::pow(offset * 700.0, 2) * 1e-3 / std::sqrt(1e3);
        EXPECT_NEAR(back->covariance(i, j) / size, surface.covariance(i, j) / size,
                    1e-12 + left_out);
      }
    }
  }
}

TEST(TipRadius, CircleTouchedFromOutsideAndInside) {
  // Travelled counter-clockwise, material on the left (outside touch): the centre lies on the
  // right, at R + r; inside a ring, material on the right, it lies on the left, at R - r.
  LocalEstimate surface;
  surface.kappa = 1.0 / 0.020;
  surface.window_arc_m = 0.020;  // a radian
  const auto outside = surface_from_tip(surface, 0.003);
  const auto inside = surface_from_tip(surface, -0.003);
  EXPECT_NEAR(outside->kappa, 1.0 / 0.023, 1e-12);
  EXPECT_NEAR(inside->kappa, 1.0 / 0.017, 1e-12);
  EXPECT_NEAR(outside->window_arc_m, 0.023, 1e-15);
  EXPECT_NEAR(inside->window_arc_m, 0.017, 1e-15);
}

}  // namespace
}  // namespace palpate
