// Every row of the 50-digit reference.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

#include "core/curves/curve.h"
#include "tests/support/reference_curves.h"

namespace palpate {
namespace {

constexpr double kEpsilon = 2.220446049250313e-16;

Eigen::Vector3d values_of(const test::ReferenceCurve& curve) {
  if (curve.curve_class == CurveClass::CubicalParabola) {
    return {curve.a, curve.c, 0.0};
  }
  return {curve.a, curve.b, curve.c};
}

/// Condition of the formulas: size of the largest term that is added over the size of the sum, for
/// quantities whose sum may cancel. Rounding then costs a few epsilons times this, whatever the
/// order of evaluation.
struct Conditioning {
  double kappa = 1.0;
  double kappa_s = 1.0;
  double angle = 1.0;
};

Conditioning conditioning(CurveClass curve_class, const Eigen::Vector3d& v, double t) {
  Conditioning c;
  if (curve_class == CurveClass::CubicalParabola) {
    // kappa_s: q - 18 a t^2 lambda; slope: 3 a t^2 + c.
    const double term = 3.0 * v[0] * t * t;
    const double slope = term + v[1];
    const double q = 1.0 + slope * slope;
    const double slope_condition = (std::abs(term) + std::abs(v[1])) / (std::abs(slope) + 1.0);
    c.angle = c.kappa = 1.0 + 3.0 * slope_condition * std::abs(slope);
    const double part = 6.0 * term * slope;
    c.kappa_s = c.kappa * (q + std::abs(part) * (1.0 + slope_condition)) / std::abs(q - part);
  } else if (curve_class == CurveClass::SemiCubicalParabola) {
    const double term = 1.5 * v[0] * t;
    const double slope = term + v[1];
    const double q = 1.0 + slope * slope;
    const double slope_condition = (std::abs(term) + std::abs(v[1])) / (std::abs(slope) + 1.0);
    c.angle = c.kappa = 1.0 + 3.0 * slope_condition * std::abs(slope);
    const double part = 3.0 * term * slope;
    c.kappa_s = c.kappa * (q + std::abs(part) * (1.0 + slope_condition)) / std::abs(q + part);
  } else if (curve_class == CurveClass::CubicSpline) {
    const double y1 = (3.0 * v[0] * t + 2.0 * v[1]) * t + v[2];
    const double y1_size = 3.0 * v[0] * t * t + std::abs(2.0 * v[1] * t) + std::abs(v[2]);
    const double y2 = 6.0 * v[0] * t + 2.0 * v[1];
    const double y2_size = std::abs(6.0 * v[0] * t) + std::abs(2.0 * v[1]);
    const double bend = 6.0 * v[0] * t * t - 2.0 * v[2];
    const double bend_size = 6.0 * v[0] * t * t + 2.0 * std::abs(v[2]);
    const double speed2 = 4.0 * t * t + y1 * y1;
    const double speed2_size = 4.0 * t * t + std::abs(y1) * y1_size;
    const double speed_condition = speed2_size / speed2;
    c.angle = y1_size / std::sqrt(speed2);
    c.kappa = bend_size / std::abs(bend) + 1.5 * speed_condition;
    const double left = 12.0 * v[0] * t * speed2;
    const double right = 3.0 * bend * (4.0 * t + y1 * y2);
    const double right_size =
        3.0 * bend_size * (4.0 * std::abs(t) + y1_size * std::abs(y2) + std::abs(y1) * y2_size);
    c.kappa_s = (std::abs(left) * speed_condition + right_size) / std::abs(left - right) +
                3.0 * speed_condition;
  }
  return c;
}

double relative_error(double value, double expected) {
  return expected == 0.0 ? std::abs(value) : std::abs(value - expected) / std::abs(expected);
}

TEST(CurveReference, EveryRowToRoundingTimesConditioning) {
  // Each formula has fewer than 32 roundings of 2^-53 (the cube of a squared speed counts its own
  // threefold), each magnified by at most the condition computed above: 16 epsilon times that. This
  // is 1e-12 or better wherever the condition is below 280.
  constexpr double kRounding = 16.0 * kEpsilon;
  struct Worst {
    double x = 0.0, y = 0.0, angle = 0.0, kappa = 0.0, kappa_s = 0.0;
  };
  std::map<CurveClass, Worst> worst;
  int rows = 0;
  int wider_bounds = 0;
  int beyond = 0;
  for (const test::ReferenceCurve& reference : test::reference_curves()) {
    const Eigen::Vector3d values = values_of(reference);
    const auto curve = make_curve(reference.curve_class, values);
    ASSERT_TRUE(curve.has_value());
    EXPECT_EQ(class_of(*curve), reference.curve_class);
    for (const test::ReferencePoint& point : reference.points) {
      SCOPED_TRACE(std::string(name_of(reference.curve_class)) +
                   " a=" + std::to_string(reference.a) + " t=" + std::to_string(point.t));
      ++rows;
      const Vec2 p = position(*curve, point.t);
      const LocalGeometry g = geometry(*curve, point.t);
      const Conditioning condition = conditioning(reference.curve_class, values, point.t);
      // At the origin (a vertex, an inflection) the position is exact.
      const double size = std::max(std::hypot(point.x, point.y), 1e-300);
      const double x_error = std::abs(p.x() - point.x) / size;
      const double y_error = std::abs(p.y() - point.y) / size;
      const double angle_error = std::abs(wrap_angle(g.tangent_angle - point.tangent_angle));
      const double kappa_error = relative_error(g.kappa, point.kappa);
      const double kappa_s_error = relative_error(g.kappa_s, point.kappa_s);
      EXPECT_LE(x_error, kRounding);
      EXPECT_LE(y_error, kRounding);
      EXPECT_LE(angle_error, kRounding * condition.angle);
      EXPECT_LE(kappa_error, kRounding * condition.kappa);
      EXPECT_LE(kappa_s_error, kRounding * condition.kappa_s);
      wider_bounds += std::max(condition.kappa, condition.kappa_s) * kRounding > 1e-12 ? 1 : 0;
      beyond += std::max(kappa_error, kappa_s_error) > 1e-12 ? 1 : 0;
      Worst& w = worst[reference.curve_class];
      w.x = std::max(w.x, x_error);
      w.y = std::max(w.y, y_error);
      w.angle = std::max(w.angle, angle_error);
      w.kappa = std::max(w.kappa, kappa_error);
      w.kappa_s = std::max(w.kappa_s, kappa_s_error);
    }
  }
  EXPECT_EQ(rows, 423);
  EXPECT_EQ(beyond, 0);
  std::cout << rows << " rows, " << wider_bounds << " with a derived bound above 1e-12, " << beyond
            << " with an error above 1e-12\nworst errors (x and y by size, angle in rad, kappa and "
               "kappa_s relative):\n";
  for (const auto& [curve_class, w] : worst) {
    std::cout << "  " << name_of(curve_class) << ": x " << w.x << " y " << w.y << " angle "
              << w.angle << " kappa " << w.kappa << " kappa_s " << w.kappa_s << "\n";
  }
}

TEST(CurveReference, PositionChangesWithParametersAsDerivativesSay) {
  for (const test::ReferenceCurve& reference : test::reference_curves()) {
    const Eigen::Vector3d values = values_of(reference);
    const auto letters = static_cast<Eigen::Index>(parameter_letters(reference.curve_class).size());
    for (const test::ReferencePoint& point : reference.points) {
      const auto exact =
          position_by_parameters(*make_curve(reference.curve_class, values), point.t);
      for (Eigen::Index k = 0; k < letters; ++k) {
        const double h = 1e-6 * std::max(std::abs(values[k]), 1e-6);
        Eigen::Vector3d up = values;
        Eigen::Vector3d down = values;
        up[k] += h;
        down[k] -= h;
        const auto curve_up = make_curve(reference.curve_class, up);
        const auto curve_down = make_curve(reference.curve_class, down);
        if (!curve_up || !curve_down) {
          continue;  // a just above b
        }
        const Vec2 slope =
            (position(*curve_up, point.t) - position(*curve_down, point.t)) / (up[k] - down[k]);
        // Positions are linear in the parameters: only rounding separates the two.
        const double rounding = 8.0 * kEpsilon * position(*curve_up, point.t).norm() / h + 1e-12;
        EXPECT_LE((slope - exact.col(k)).norm(), rounding);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
