// Where on the curve: exact local geometry leads back to its place, modulo symmetry.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "core/curves/curve.h"
#include "tests/support/reference_curves.h"

namespace palpate {
namespace {

/// Sum of the relative conditions of t by kappa, kappa_s and the angle: numerically, by trying.
double sensitivity(const Curve& curve, const LocalGeometry& g, double t) {
  constexpr double kRelative = 1e-10;
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    LocalGeometry moved = g;
    double& value = k == 0 ? moved.kappa : k == 1 ? moved.kappa_s : moved.tangent_angle;
    value += kRelative * std::max(std::abs(value), k == 2 ? 1.0 : 0.0);
    const auto place = localise(curve, moved);
    if (place) {
      double d = place->t - t;
      if (class_of(curve) == CurveClass::Ellipse) {
        d = std::remainder(d, kPi);
      }
      sum += std::abs(d) / kRelative;
    }
  }
  return sum;
}

TEST(Localisation, ReturnsItsParameterModuloSymmetry) {
  int checked = 0;
  double worst = 0.0;
  for (const test::ReferenceCurve& reference : test::reference_curves()) {
    const Eigen::Vector3d values = reference.curve_class == CurveClass::CubicalParabola
                                       ? Eigen::Vector3d(reference.a, reference.c, 0.0)
                                       : Eigen::Vector3d(reference.a, reference.b, reference.c);
    const Curve curve = *make_curve(reference.curve_class, values);
    for (const test::ReferencePoint& point : reference.points) {
      const LocalGeometry g{point.tangent_angle, point.kappa, point.kappa_s};
      for (const bool along : {true, false}) {
        const auto place = localise(curve, along ? g : reversed(g));
        ASSERT_TRUE(place.has_value()) << name_of(reference.curve_class) << " " << point.t;
        double error = place->t - point.t;
        if (reference.curve_class == CurveClass::Ellipse) {
          error = std::remainder(error, kPi);
        }
        // Each input is rounded once and each formula has fewer than 30 roundings of 2^-53.
        const double bound =
            16.0 * std::numeric_limits<double>::epsilon() *
            (std::abs(point.t) + sensitivity(curve, along ? g : reversed(g), place->t));
        EXPECT_LE(std::abs(error), bound)
            << name_of(reference.curve_class) << " a=" << values.transpose() << " t=" << point.t;
        worst = std::max(worst, std::abs(error));
        EXPECT_EQ(place->along_increasing_t, along)
            << name_of(reference.curve_class) << " t=" << point.t;
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 2 * 423);
  std::cout << "worst error of t from the reference: " << worst << "\n";
}

TEST(Localisation, PosePutsTheContactWhereItWas) {
  const Pose2 world_T_curve{0.3, -0.2, 2.5};
  const Curve curve = Hyperbola{0.02, 0.03};
  for (const double t : {-1.2, 0.0, 0.7}) {
    for (const bool along : {true, false}) {
      const double angle =
          geometry(curve, t).tangent_angle + world_T_curve.theta + (along ? 0.0 : kPi);
      const Pose2 pose = pose_from_contact(curve, {t, along}, world_T_curve * position(curve, t),
                                           wrap_angle(angle));
      EXPECT_NEAR(pose.x, world_T_curve.x, 1e-15);
      EXPECT_NEAR(pose.y, world_T_curve.y, 1e-15);
      EXPECT_NEAR(wrap_angle(pose.theta - world_T_curve.theta), 0.0, 1e-14);
    }
  }
}

TEST(Localisation, UndeterminedPlacesAreNone) {
  EXPECT_FALSE(localise(Ellipse{1.0, 1.0}, {0.0, 1.0, 0.0}).has_value());    // a circle
  EXPECT_FALSE(localise(Ellipse{2.0, 1.0}, {0.0, 0.0, 1.0}).has_value());    // no inflection
  EXPECT_FALSE(localise(Parabola{1.0}, {0.0, 0.0, 0.0}).has_value());        // at infinity
  EXPECT_FALSE(localise(Hyperbola{1.0, 1.0}, {0.0, 0.0, 0.0}).has_value());  // at infinity
  EXPECT_FALSE(localise(Circle{1.0}, {0.0, 0.0, 0.0}).has_value());  // no direction of travel
  EXPECT_FALSE(localise(SemiCubicalParabola{1.0, 0.0}, {0.0, 0.0, 0.0}).has_value());
}

TEST(Localisation, LineAndCircleAreAnywhere) {
  const auto on_line = localise(Line{}, {1.0, 1e-3, 0.0});
  ASSERT_TRUE(on_line.has_value());
  EXPECT_EQ(on_line->t, 0.0);
  EXPECT_TRUE(on_line->along_increasing_t);
  const auto on_circle = localise(Circle{2.0}, {1.0, -0.5, 1e-3});
  ASSERT_TRUE(on_circle.has_value());
  EXPECT_EQ(on_circle->t, 0.0);
  EXPECT_FALSE(on_circle->along_increasing_t);
}

}  // namespace
}  // namespace palpate
