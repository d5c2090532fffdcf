// Properties that every curve class must have, over random curves of very different sizes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/curves/curve.h"
#include "tests/property/curves/random_curves.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

class CurveProperties : public testing::TestWithParam<CurveClass> {};

TEST_P(CurveProperties, DerivativesAreThoseOfThePosition) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t = uniform(rng, random.t_least, random.t_most);
    const CurveDerivatives d = derivatives(random.curve, t);
    // Fourth-order central differences with step 1e-3. Truncation: h^4/30 times the fifth
    // derivative (below 1e-12 of the largest derivative here). Rounding: 1e-16 / h.
    const double h = 1e-3;
    const auto difference = [&](auto field) {
      return Vec2((8.0 * (field(t + h) - field(t - h)) - (field(t + 2 * h) - field(t - 2 * h))) /
                  (12.0 * h));
    };
    const double size = 1.0 + d.position.norm() + d.first.norm() + d.second.norm() + d.third.norm();
    const double bound = 1e-11 * size;
    EXPECT_LE((d.position - position(random.curve, t)).norm(), 1e-15 * size);
    EXPECT_LE((difference([&](double u) { return position(random.curve, u); }) - d.first).norm(),
              bound);
    EXPECT_LE((difference([&](double u) { return derivatives(random.curve, u).first; }) - d.second)
                  .norm(),
              bound);
    EXPECT_LE((difference([&](double u) { return derivatives(random.curve, u).second; }) - d.third)
                  .norm(),
              bound);
  }
}

TEST_P(CurveProperties, GeometryIsThatOfTheDerivatives) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t = uniform(rng, random.t_least, random.t_most);
    const CurveDerivatives d = derivatives(random.curve, t);
    const LocalGeometry g = geometry(random.curve, t);
    const double v = d.first.norm();
    if (v < 1e-2) {
      continue;  // next to a cusp the general formula is ill-conditioned
    }
    const double bend = cross(d.first, d.second);
    const double kappa = bend / (v * v * v);  // (1)
    const double kappa_s =
        (cross(d.first, d.third) * v * v - 3.0 * bend * d.first.dot(d.second)) / std::pow(v, 6);
    const double size = d.first.norm() * d.second.norm() / (v * v * v);
    EXPECT_LE(std::abs(g.kappa - kappa), 1e-13 * size);
    const double size_s =
        (d.first.norm() * d.third.norm() * v * v + 3.0 * v * v * d.second.squaredNorm()) /
        std::pow(v, 6);
    EXPECT_LE(std::abs(g.kappa_s - kappa_s), 1e-13 * (size_s + std::abs(kappa_s)));
    EXPECT_LE(std::abs(wrap_angle(g.tangent_angle - std::atan2(d.first.y(), d.first.x()))), 1e-14);
  }
}

TEST_P(CurveProperties, ArcLengthAddsUpAndInverts) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(100); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t0 = uniform(rng, random.t_least, random.t_most);
    const double t1 = uniform(rng, random.t_least, random.t_most);
    const double t2 = uniform(rng, random.t_least, random.t_most);
    const double s01 = arc_length(random.curve, t0, t1);
    const double s12 = arc_length(random.curve, t1, t2);
    EXPECT_NEAR(s01 + s12, arc_length(random.curve, t0, t2),
                2e-13 * (std::abs(s01) + std::abs(s12)));
    EXPECT_NEAR(s01, -arc_length(random.curve, t1, t0), 1e-13 * std::abs(s01));
    EXPECT_GE(std::abs(s01) * (1.0 + 1e-13),
              (position(random.curve, t1) - position(random.curve, t0)).norm());
    const double back = parameter_at_arc_length(random.curve, t0, s01);
    // Compared in arc length: near a cusp t itself is ill-conditioned.
    EXPECT_NEAR(arc_length(random.curve, t0, back), s01, 1e-12 * (std::abs(s01) + 1e-3));
  }
}

TEST_P(CurveProperties, ScaleEquivariance) {
  std::mt19937_64 rng = test::test_rng();
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
    for (int i = 0; i < test::stress_count(200); ++i) {
      const RandomCurve random = random_curve(GetParam(), rng);
      const double t = random.random_t(rng);
      const double scaled_t = scaled_parameter(GetParam(), t, factor);
      const Curve large = scaled(random, factor);
      const LocalGeometry g = geometry(random.curve, t);
      const LocalGeometry h = geometry(large, scaled_t);
      // Parameters and t are rounded again. Near a sharp bend, curvatures are as sensitive to that
      // as they are large: 1e-12 of their natural size.
      const double size = std::max(std::abs(g.kappa), 1.0);
      EXPECT_LE(std::abs(h.kappa * factor - g.kappa), 1e-12 * size);
      EXPECT_LE(std::abs(h.kappa_s * factor * factor - g.kappa_s),
                1e-12 * (std::abs(g.kappa_s) + size * size * size));
      const Vec2 point(uniform(rng, -2.0, 2.0), uniform(rng, -2.0, 2.0));
      const double distance = foot_point(random.curve, point).distance;
      const double scaled_distance = foot_point(large, factor * point).distance / factor;
      // The sign is not determined if two foot points on opposite sides are equally near.
      EXPECT_NEAR(std::abs(scaled_distance), std::abs(distance), 1e-14);
      const double u = random.random_t(rng);
      const double length = arc_length(random.curve, t, u);
      EXPECT_NEAR(arc_length(large, scaled_t, scaled_parameter(GetParam(), u, factor)) / factor,
                  length, 1e-14 * (1.0 + std::abs(length)));
    }
  }
}

TEST_P(CurveProperties, PositionIsDifferentiatedByItsParameters) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(500); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t = random.random_t(rng);
    const auto by_parameters = position_by_parameters(random.curve, t);
    // Every canonical form is linear in its parameters, except for x of the polynomial ones.
    const Vec2 other = position(random.curve, t) - by_parameters * parameters(random.curve);
    const double x =
        GetParam() == CurveClass::Line || GetParam() == CurveClass::CubicalParabola ? t
        : GetParam() == CurveClass::SemiCubicalParabola || GetParam() == CurveClass::CubicSpline
            ? t * t
            : 0.0;
    EXPECT_LE((other - Vec2(x, 0.0)).norm(), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, CurveProperties, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
