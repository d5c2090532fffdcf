// NaN, infinities and numbers at the ends of the range: each must have a defined outcome, and none
// may be NaN.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/curves/curve.h"

namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class NotFinite : public testing::TestWithParam<CurveClass> {
 protected:
  const Curve curve_ = *make_curve(GetParam(), {1.3, 0.7, 0.4});
};

TEST_P(NotFinite, PointsAreInfinitelyFar) {
  for (const Vec2& point : {Vec2(kNan, 0.0), Vec2(0.0, kNan), Vec2(kInfinity, 0.0),
                            Vec2(1.0, -kInfinity), Vec2(kNan, kInfinity)}) {
    for (const FootPoint& foot : {foot_point(curve_, point), foot_point_near(curve_, point, 0.2)}) {
      EXPECT_EQ(foot.t, 0.0);
      EXPECT_EQ(foot.position, position(curve_, 0.0));
      EXPECT_EQ(foot.distance, kInfinity);
    }
  }
}

TEST_P(NotFinite, ALostStartFindsTheGlobalFoot) {
  const Vec2 point(0.9, 0.4);
  for (const double start : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(foot_point_near(curve_, point, start).t, foot_point(curve_, point).t);
  }
}

TEST_P(NotFinite, GeometryIsNowhere) {
  const LocalGeometry g = geometry(curve_, 0.3);
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_FALSE(localise(curve_, {bad, g.kappa, g.kappa_s}).has_value());
    EXPECT_FALSE(localise(curve_, {g.tangent_angle, bad, g.kappa_s}).has_value());
    EXPECT_FALSE(localise(curve_, {g.tangent_angle, g.kappa, bad}).has_value());
  }
}

TEST_P(NotFinite, ExtremeGeometryIsAPlaceOrNone) {
  for (const double kappa : {1e-300, -1e-150, 1e150, -1e300}) {
    for (const double kappa_s : {0.0, 1e-300, -1e300}) {
      for (const double angle : {0.0, 0.5 * kPi, -1e-300, 3.0}) {
        const auto place = localise(curve_, {angle, kappa, kappa_s});
        EXPECT_TRUE(!place || std::isfinite(place->t));
      }
    }
  }
}

TEST_P(NotFinite, GeometryFarOutIsStillANumber) {
  for (const double t : {1e3, -1e6, 1e20, -1e60}) {
    if (GetParam() == CurveClass::Hyperbola) {
      continue;  // exp(t); see below
    }
    const LocalGeometry g = geometry(curve_, t);
    EXPECT_TRUE(is_finite(g)) << t;
  }
  EXPECT_TRUE(is_finite(geometry(Hyperbola{1.0, 2.0}, 700.0)));
}

TEST_P(NotFinite, ParametersMakeNoCurve) {
  const std::size_t count = parameter_letters(GetParam()).size();
  for (std::size_t k = 0; k < count; ++k) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      Eigen::Vector3d values(1.3, 0.7, 0.4);
      values[static_cast<Eigen::Index>(k)] = bad;
      EXPECT_FALSE(make_curve(GetParam(), values).has_value());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, NotFinite, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
