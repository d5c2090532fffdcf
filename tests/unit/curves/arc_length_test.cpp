// Arc lengths against 40-digit quadrature, and the inverse.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "core/curves/arc_length.h"
#include "core/curves/curve.h"

namespace palpate {
namespace {

struct KnownArc {
  const char* name;
  Curve curve;
  double t0, t1, length;
};

// mpmath.quad at 40 digits with the arc cut where the speed bends sharply; the perimeters are 4 a
// E(e^2).
const KnownArc kKnownArcs[] = {
    {"line", Line{}, -2.0, 0.5, 2.5},
    {"circle", Circle{0.02}, 1.0, -2.0, -0.06},
    {"ellipse", Ellipse{2.5, 1.75}, 0.3, 2.0, 3.8876291956395719856},
    {"ellipse 100:1, across a vertex", Ellipse{100.0, 1.0}, -0.1, 0.3, 5.0061865911206537592},
    {"ellipse 100:1, whole turn", Ellipse{100.0, 1.0}, -kPi, kPi, 400.10983297226518607},
    {"ellipse 1e6:1, next to a vertex", Ellipse{1e6, 1.0}, 0.01, 0.02, 149.99375043401046711},
    {"ellipse 1e6:1, whole turn", Ellipse{1e6, 1.0}, -kPi, kPi, 4000000.0000294036098},
    {"parabola", Parabola{0.02}, -1.5, 3.0, 0.3040841222724461282},
    {"parabola, one arm", Parabola{0.02}, 2.0, 2.5, 0.049258314502216721313},
    {"parabola, short and far out", Parabola{0.02}, 1e3, 1e3 + 1e-9, 3.9999596983776876345e-8},
    {"hyperbola 1000:1", Hyperbola{1e3, 1.0}, -2.0, 1.0, 3305.2862504444437126},
    {"cubical parabola", CubicalParabola{0.6, 0.4}, -1.0, 2.0, 7.6433035383166252726},
    {"cubical parabola, sharp", CubicalParabola{900.0, 0.3}, -0.05, 0.02, 0.16801417457369110176},
    {"semi-cubical, through the cusp", SemiCubicalParabola{1.2, -0.8}, -1.0, 0.5,
     2.505605639963483658},
    {"spline", CubicSpline{2.76866, -1.26705, -2.32763}, -1.2, 1.5, 11.45335235238152944},
    {"spline, all but a cusp", CubicSpline{1.5, 0.4, 1e-6}, -1.0, 1.0, 3.7062314184975119851},
};

TEST(ArcLength, AgreesWithFortyDigits) {
  double worst = 0.0;
  for (const KnownArc& known : kKnownArcs) {
    const double forward = arc_length(known.curve, known.t0, known.t1);
    const double error = std::abs(forward / known.length - 1.0);
    EXPECT_LE(error, 1e-13) << known.name << " " << forward;
    EXPECT_LE(std::abs(arc_length(known.curve, known.t1, known.t0) / known.length + 1.0), 1e-13)
        << known.name << ", backwards";
    EXPECT_EQ(arc_length(known.curve, known.t0, known.t0), 0.0) << known.name;
    worst = std::max(worst, error);
  }
  std::cout << "worst relative error of an arc length: " << worst << "\n";
}

TEST(ArcLength, IsInvertedFromBothEnds) {
  for (const KnownArc& known : kKnownArcs) {
    // In arc length, which t's own rounding moves by speed * epsilon * |t|.
    const double rounding = 1e-13 * std::abs(known.length) +
                            4.0 * std::numeric_limits<double>::epsilon() * std::abs(known.t1) *
                                std::max(derivatives(known.curve, known.t0).first.norm(),
                                         derivatives(known.curve, known.t1).first.norm());
    const double end = parameter_at_arc_length(known.curve, known.t0, known.length);
    EXPECT_NEAR(arc_length(known.curve, known.t1, end), 0.0, rounding) << known.name;
    const double start = parameter_at_arc_length(known.curve, known.t1, -known.length);
    EXPECT_NEAR(arc_length(known.curve, known.t0, start), 0.0, rounding) << known.name;
    EXPECT_EQ(parameter_at_arc_length(known.curve, known.t0, 0.0), known.t0) << known.name;
  }
}

// Where large terms of the speed cancel, halving a piece changes it by their rounding, however
// short it is: without a bound a length takes a second.
TEST(ArcLength, RoundingOfTheSpeedIsNotHalvedWithoutEnd) {
  const CubicSpline spline{5302876.2722558016, -36888693.503144391, 85536961.32522054};  // y' -> 0
  const double from = 2.3187;
  const double to = 2.3193;
  const double rounding = rounding_of_terms((3.0 * spline.a * to - 2.0 * spline.b) * to + spline.c);
  int asked = 0;
  const auto speed = [&](double t) {
    ++asked;
    return spline.derivatives(t).first.norm();
  };
  constexpr double kLength = 0.0040996868748434596720532;  // mpmath.quad at 50 digits
  const double length = integrate_speed(speed, from, to, rounding);
  EXPECT_NEAR(length, kLength, rounding * (to - from));
  EXPECT_EQ(spline.arc_length(from, to), length);
  // The rule asks 12 times a piece. Each level halves the piece that holds the bend, of 1e-4 of t.
  EXPECT_LT(asked, 12 * 2 * 60);

  // Either sign of a, where the terms of the slope cancel.
  const CubicalParabola rising{1e9, -3e9};
  const CubicalParabola falling{-1e9, 3e9};
  constexpr double kOfCubical = 6.4980591657240570502e-9;
  const double of_terms = rounding_of_terms(6e9);
  EXPECT_NEAR(rising.arc_length(1.0 - 1e-9, 1.0 + 1e-9), kOfCubical, of_terms * 2e-9);
  EXPECT_EQ(falling.arc_length(1.0 - 1e-9, 1.0 + 1e-9), rising.arc_length(1.0 - 1e-9, 1.0 + 1e-9));

  // A slender ellipse about the vertex at half a turn, where t has rounding.
  const Ellipse ellipse{1e10, 1.0};
  const double of_angle = ellipse.a * std::numeric_limits<double>::epsilon() * kPi;
  EXPECT_NEAR(ellipse.arc_length(3.1415926535, 3.1415926536), 1.1093107465119032588e-10,
              of_angle * 1e-10);
}

TEST(ArcLength, EllipseRunsOnOverManyTurns) {
  const Ellipse ellipse{3.0, 0.2};
  const double turn = ellipse.arc_length(0.0, 2.0 * kPi);
  EXPECT_NEAR(ellipse.arc_length(0.4, 0.4 + 14.0 * kPi) / turn, 7.0, 1e-13);
  EXPECT_NEAR(ellipse.parameter_at_arc_length(-1.0, -5.0 * turn), -1.0 - 10.0 * kPi, 1e-12);
}

}  // namespace
}  // namespace palpate
