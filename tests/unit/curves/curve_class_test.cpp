// Names, letters and ranges of the classes.
#include "core/curves/curve_class.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/curves/curve.h"

namespace palpate {
namespace {

TEST(CurveClassNames, RoundTrip) {
  for (const CurveClass curve_class : kCurveClasses) {
    EXPECT_EQ(curve_class_from_name(name_of(curve_class)), curve_class);
  }
  EXPECT_EQ(curve_class_from_name("Semi-Cubical Parabola"), CurveClass::SemiCubicalParabola);
  EXPECT_FALSE(curve_class_from_name("banana").has_value());
  EXPECT_FALSE(curve_class_from_name("").has_value());
}

TEST(CurveClassFacts, LettersMatchTheStructs) {
  for (const CurveClass curve_class : kCurveClasses) {
    const auto curve = make_curve(curve_class, {3.0, 2.0, 1.0});
    ASSERT_TRUE(curve.has_value());
    EXPECT_EQ(class_of(*curve), curve_class);
    const std::size_t count = std::visit(
        [](const auto& c) { return static_cast<std::size_t>(c.parameter_count); }, *curve);
    EXPECT_EQ(parameter_letters(curve_class).size(), count);
    const int free_pose = pose_symmetry(curve_class) == 0 ? 2 : 3;
    EXPECT_EQ(degrees_of_freedom(curve_class), static_cast<int>(count) + free_pose);
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    expected.head(static_cast<Eigen::Index>(count)) =
        Eigen::Vector3d(3.0, 2.0, 1.0).head(static_cast<Eigen::Index>(count));
    EXPECT_EQ(parameters(*curve), expected);
  }
}

TEST(MakeCurve, RefusesWhatIsNoCanonicalForm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(make_curve(CurveClass::Unclassified, {1.0, 1.0, 1.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::Circle, {0.0, 0.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::Ellipse, {1.0, 2.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::Ellipse, {1.0, 0.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::Ellipse, {inf, 1.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::Parabola, {-1.0, 0.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::Hyperbola, {1.0, nan, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::CubicalParabola, {0.0, 1.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::SemiCubicalParabola, {-1.0, 1.0, 0.0}).has_value());
  EXPECT_FALSE(make_curve(CurveClass::CubicSpline, {1.0, 1.0, 0.0}).has_value());
}

}  // namespace
}  // namespace palpate
