// Laws that every curve class obeys, over random curves and several magnitudes of size.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/curves/curve.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

double uniform(std::mt19937_64& rng, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(rng);
}

struct RandomCurve {
  Curve curve;
  Eigen::Vector3d values;
  double t_least, t_most;
};

RandomCurve random_curve(CurveClass curve_class, std::mt19937_64& rng) {
  const double sign = uniform(rng, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  double reach = 1.5;
  switch (curve_class) {
    case CurveClass::Ellipse:
      v[0] = uniform(rng, 1.0, 2.0);
      v[1] = uniform(rng, 0.05, 1.0);
      reach = kPi;
      break;
    case CurveClass::Circle:
      v[0] = uniform(rng, 0.3, 3.0);
      reach = kPi;
      break;
    case CurveClass::CubicalParabola:
      v[0] = sign * uniform(rng, 0.1, 3.0);
      v[1] = uniform(rng, -2.0, 2.0);
      break;
    case CurveClass::CubicSpline:
      v = {uniform(rng, 0.1, 3.0), uniform(rng, -2.0, 2.0), sign * uniform(rng, 0.05, 2.0)};
      break;
    case CurveClass::SemiCubicalParabola:
      v = {uniform(rng, 0.1, 3.0), uniform(rng, -2.0, 2.0), 0.0};
      break;
    default:
      v = {uniform(rng, 0.2, 3.0), uniform(rng, 0.2, 3.0), 0.0};
  }
  if (curve_class == CurveClass::Line) {
    v.setZero();
  }
  if (curve_class == CurveClass::Parabola) {
    v[1] = 0.0;
  }
  return {*make_curve(curve_class, v), v, -reach, reach};
}

class CurveProperties : public testing::TestWithParam<CurveClass> {};

TEST_P(CurveProperties, DerivativesAreThoseOfThePosition) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(1000); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double t = uniform(rng, random.t_least, random.t_most);
    const CurveDerivatives d = derivatives(random.curve, t);
    // Fourth-order central differences, step 1e-3: truncation h^4/30 times the fifth derivative
    // (below 1e-12 of the largest derivative here), rounding 1e-16 / h.
    const double h = 1e-3;
    const auto difference = [&](auto field) {
      return Vec2((8.0 * (field(t + h) - field(t - h)) - (field(t + 2 * h) - field(t - 2 * h))) /
                  (12.0 * h));
    };
    const double size = 1.0 + d.position.norm() + d.first.norm() + d.second.norm() +
                        d.third.norm();
    const double bound = 1e-11 * size;
    EXPECT_LE((d.position - position(random.curve, t)).norm(), 1e-15 * size);
    EXPECT_LE((difference([&](double u) { return position(random.curve, u); }) - d.first).norm(),
              bound);
    EXPECT_LE((difference([&](double u) { return derivatives(random.curve, u).first; }) -
               d.second).norm(), bound);
    EXPECT_LE((difference([&](double u) { return derivatives(random.curve, u).second; }) -
               d.third).norm(), bound);
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
      continue;  // next to a cusp the general formula is the ill-conditioned one
    }
    const double bend = cross(d.first, d.second);
    const double kappa = bend / (v * v * v);                                         // (1)
    const double kappa_s =
        (cross(d.first, d.third) * v * v - 3.0 * bend * d.first.dot(d.second)) / std::pow(v, 6);
    const double size = d.first.norm() * d.second.norm() / (v * v * v);
    EXPECT_LE(std::abs(g.kappa - kappa), 1e-13 * size);
    const double size_s = (d.first.norm() * d.third.norm() * v * v +
                           3.0 * v * v * d.second.squaredNorm()) / std::pow(v, 6);
    EXPECT_LE(std::abs(g.kappa_s - kappa_s), 1e-13 * (size_s + std::abs(kappa_s)));
    EXPECT_LE(std::abs(wrap_angle(g.tangent_angle - std::atan2(d.first.y(), d.first.x()))),
              1e-14);
  }
}

TEST_P(CurveProperties, FootPointIsNoFartherThanAnyOfManyPoints) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(300); ++i) {
    const RandomCurve random = random_curve(GetParam(), rng);
    const double reach = std::pow(10.0, uniform(rng, -2.0, 1.0));
    const Vec2 point(uniform(rng, -reach, reach), uniform(rng, -reach, reach));
    const FootPoint foot = foot_point(random.curve, point);
    EXPECT_LE((foot.position - position(random.curve, foot.t)).norm(), 1e-14);
    EXPECT_NEAR(std::abs(foot.distance), (point - foot.position).norm(), 1e-14);
    for (int k = 0; k <= 400; ++k) {
      const double t = 2.0 * (random.t_least + (random.t_most - random.t_least) * k / 400.0);
      const double distance = (position(random.curve, t) - point).norm();
      ASSERT_GE(distance, std::abs(foot.distance) * (1.0 - 1e-12) - 1e-13)
          << name_of(GetParam()) << " " << random.values.transpose() << " point "
          << point.transpose() << " t " << t;
    }
    // Perpendicular, or at a cusp.
    const CurveDerivatives d = derivatives(random.curve, foot.t);
    EXPECT_LE(std::abs((point - foot.position).dot(d.first)),
              1e-7 * (1.0 + d.first.norm()) * (point - foot.position).norm() + 1e-12);
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
    // In arc length: near a cusp t itself is ill-conditioned.
    EXPECT_NEAR(arc_length(random.curve, t0, back), s01, 1e-12 * (std::abs(s01) + 1e-3));
  }
}

TEST_P(CurveProperties, ScaleEquivariance) {
  std::mt19937_64 rng = test::test_rng();
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
    for (int i = 0; i < test::stress_count(200); ++i) {
      const RandomCurve random = random_curve(GetParam(), rng);
      double t = uniform(rng, random.t_least, random.t_most);
      Eigen::Vector3d v = random.values * factor;
      double scaled_t = t;
      if (GetParam() == CurveClass::CubicalParabola) {
        v = {random.values[0] / (factor * factor), random.values[1], 0.0};
        scaled_t = t * factor;
      } else if (GetParam() == CurveClass::SemiCubicalParabola ||
                 GetParam() == CurveClass::CubicSpline) {
        const double root = std::sqrt(factor);
        v = {random.values[0] / root, random.values[1], random.values[2] * root};
        scaled_t = t * root;
      } else if (GetParam() == CurveClass::Line) {
        scaled_t = t * factor;
      }
      const Curve large = *make_curve(GetParam(), v);
      const LocalGeometry g = geometry(random.curve, t);
      const LocalGeometry h = geometry(large, scaled_t);
      const double size = std::max(std::abs(g.kappa), 1.0);
      EXPECT_LE(std::abs(h.kappa * factor - g.kappa), 1e-11 * size);
      EXPECT_LE(std::abs(h.kappa_s * factor * factor - g.kappa_s),
                1e-10 * (std::abs(g.kappa_s) + size * size * size));
      const Vec2 point(uniform(rng, -2.0, 2.0), uniform(rng, -2.0, 2.0));
      EXPECT_NEAR(foot_point(large, factor * point).distance / factor,
                  foot_point(random.curve, point).distance, 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, CurveProperties, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
