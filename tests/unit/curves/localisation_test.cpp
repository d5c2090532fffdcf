// Where on the curve: exact local geometry leads back to its place, modulo symmetry.
#include <gtest/gtest.h>

#include <cmath>

#include "core/curves/curve.h"
#include "tests/support/reference_curves.h"

namespace palpate {
namespace {

LocalGeometry reversed(const LocalGeometry& g) {
  return {wrap_angle(g.tangent_angle + kPi), -g.kappa, g.kappa_s};
}

/// How much an error of one rounding in kappa, kappa_s or the angle moves t: numerically, by trying.
double sensitivity(const Curve& curve, const LocalGeometry& g, double t) {
  constexpr double kRelative = 1e-10;
  double most = 0.0;
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
      most = std::max(most, std::abs(d) / kRelative);
    }
  }
  return most;
}

TEST(Localisation, ReturnsItsParameterModuloSymmetry) {
  int checked = 0;
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
        // Inputs are rounded to doubles: a few roundings times the measured sensitivity.
        const double bound = 1e-9 * std::max(1.0, std::abs(point.t)) +
                             50.0 * 2.3e-16 * sensitivity(curve, g, point.t);
        EXPECT_LE(std::abs(error), bound)
            << name_of(reference.curve_class) << " a=" << values.transpose() << " t=" << point.t;
        EXPECT_EQ(place->along_increasing_t, along)
            << name_of(reference.curve_class) << " t=" << point.t;
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 2 * 423);
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

TEST(Localisation, UndeterminedPlacesAreNamed) {
  EXPECT_FALSE(localise(Ellipse{1.0, 1.0}, {0.0, 1.0, 0.0}).has_value());
  EXPECT_FALSE(localise(Parabola{1.0}, {0.0, 0.0, 0.0}).has_value());
  EXPECT_FALSE(localise(Line{}, {0.0, 1.0, 0.0}).has_value());
  EXPECT_FALSE(localise(SemiCubicalParabola{1.0, 0.0}, {0.0, 1.0, 0.0}).has_value());
}

}  // namespace
}  // namespace palpate
