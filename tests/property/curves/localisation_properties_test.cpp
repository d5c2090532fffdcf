// Recovers places and poses from local geometry, over random curves, poses and directions of
// travel.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/curves/curve.h"
#include "tests/property/curves/random_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

class LocalisationProperties : public testing::TestWithParam<CurveClass> {};

/// Error of a place: none for line and circle, where any place is right; modulo half a turn for an
/// ellipse.
double place_error(const Curve& curve, double t, double expected) {
  switch (class_of(curve)) {
    case CurveClass::Line:
    case CurveClass::Circle:
      return 0.0;
    case CurveClass::Ellipse:
      return std::remainder(t - expected, kPi);
    default:
      return t - expected;
  }
}

TEST_P(LocalisationProperties, PlaceAndDirectionComeBackAtAnySize) {
  std::mt19937_64 rng = test::test_rng();
  for (const double factor : {1e-6, 1.0, 1e6}) {
    for (int i = 0; i < test::stress_count(1000); ++i) {
      const RandomCurve random = random_curve(GetParam(), rng);
      const Curve curve = scaled(random, factor);
      const double unit = scaled_parameter(GetParam(), 1.0, factor);
      const double t = scaled_parameter(GetParam(), random.random_t(rng), factor);
      const bool along = random_sign(rng) > 0.0;
      const LocalGeometry g = geometry(curve, t);
      const auto place = localise(curve, along ? g : reversed(g));
      ASSERT_TRUE(place.has_value()) << random.values.transpose() << " t " << t;
      // Ellipse: D is known to a few epsilon and is divided by the squared focal distance.
      const double condition =
          GetParam() == CurveClass::Ellipse
              ? 1.0 + std::pow(random.values[0], 2) /
                          (std::pow(random.values[0], 2) - std::pow(random.values[1], 2))
              : 1.0;
      EXPECT_LE(std::abs(place_error(curve, place->t, t)), 1e-12 * condition * unit)
          << random.values.transpose() << " t " << t << " found " << place->t;
      if (GetParam() != CurveClass::Line) {
        EXPECT_EQ(place->along_increasing_t, along);
      }
    }
  }
}

TEST_P(LocalisationProperties, PoseComesBackFromAContact) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const Pose2 world_T_curve{uniform(rng, -10.0, 10.0), uniform(rng, -10.0, 10.0),
                              uniform(rng, -kPi, kPi)};
    const double t = random.random_t(rng);
    const bool along = random_sign(rng) > 0.0;
    const double angle = wrap_angle(world_T_curve.theta + geometry(random.curve, t).tangent_angle +
                                    (along ? 0.0 : kPi));
    const Pose2 found = pose_from_contact(random.curve, {t, along},
                                          world_T_curve * position(random.curve, t), angle);
    EXPECT_NEAR(wrap_angle(found.theta - world_T_curve.theta), 0.0, 4e-15);
    // The rounding of the angle turns the curve about the contact, at most 6 m away.
    EXPECT_LE((found.translation() - world_T_curve.translation()).norm(), 4e-14);
    // Equivariance: moving the whole scene moves the pose.
    const Pose2 motion{uniform(rng, -10.0, 10.0), uniform(rng, -10.0, 10.0),
                       uniform(rng, -kPi, kPi)};
    const Pose2 moved = pose_from_contact(random.curve, {t, along},
                                          motion * (world_T_curve * position(random.curve, t)),
                                          wrap_angle(angle + motion.theta));
    const Pose2 expected = motion * world_T_curve;
    EXPECT_NEAR(wrap_angle(moved.theta - expected.theta), 0.0, 8e-15);
    EXPECT_LE((moved.translation() - expected.translation()).norm(), 8e-14);
  }
}

TEST_P(LocalisationProperties, NoisyGeometryLeadsNextToThePlace) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, 1e-6);
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t = random.random_t(rng);
    LocalGeometry g = geometry(random.curve, t);
    const double scale = std::sqrt(g.kappa * g.kappa + std::abs(g.kappa_s));
    g.tangent_angle += noise(rng);
    g.kappa += scale * noise(rng);
    g.kappa_s += scale * scale * noise(rng);
    const auto place = localise(random.curve, g);
    ASSERT_TRUE(place.has_value());
    // Wherever noise moves the place, the curve there must look as measured, to 3e-3: the square
    // root of six standard deviations, because a place next to a vertex is a double root if only
    // kappa determines it.
    if (GetParam() == CurveClass::Line || GetParam() == CurveClass::Circle) {
      continue;
    }
    const LocalGeometry here = geometry(random.curve, place->t);
    EXPECT_TRUE(std::isfinite(place->t));
    EXPECT_NEAR(here.kappa / scale, g.kappa / scale, 3e-3)
        << random.values.transpose() << " t " << t << " found " << place->t;
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, LocalisationProperties, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
