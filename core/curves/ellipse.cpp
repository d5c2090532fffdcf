#include "core/curves/ellipse.h"

#include <cmath>
#include <limits>

#include "core/curves/arc_length.h"
#include "core/curves/polynomial_foot_point.h"

namespace palpate {
namespace {

/// Foot point in the first quadrant, for a point there: bisection on the Lagrange multiplier, which
/// has a single root beyond the last pole (D. Eberly, "Distance from a point to an ellipse"). Returns
/// the angle t.
double first_quadrant_angle(double a, double b, double x, double y) {
  if (y == 0.0) {
    // On the major axis: at the vertex, or off it inside the evolute's cusp at (a^2 - b^2) / a.
    const double evolute = (a - b) * (a + b) / a;
    return x < evolute ? std::acos(a * x / ((a - b) * (a + b))) : 0.0;
  }
  if (x == 0.0) {
    return 0.5 * kPi;
  }
  // g(s) = (r0 z0 / (s + r0))^2 + (z1 / (s + 1))^2 - 1, scaled by b.
  const double ratio = a / b;
  const double r0 = ratio * ratio;
  const double z0 = x / a;
  const double z1 = y / b;
  const double g_at = z0 * z0 + z1 * z1 - 1.0;
  const double n0 = r0 * z0;
  double low = z1 - 1.0;
  double high = g_at < 0.0 ? 0.0 : std::hypot(n0, z1) - 1.0;
  double s = 0.0;
  constexpr int kMostBisections = 1100;  // until the interval is a single double
  for (int i = 0; i < kMostBisections; ++i) {
    s = 0.5 * (low + high);
    if (s == low || s == high) {
      break;
    }
    const double u = n0 / (s + r0);
    const double v = z1 / (s + 1.0);
    const double g = u * u + v * v - 1.0;
    if (g > 0.0) {
      low = s;
    } else if (g < 0.0) {
      high = s;
    } else {
      break;
    }
  }
  return std::atan2(z1 / (s + 1.0), n0 / (s + r0));
}

}  // namespace

bool Ellipse::is_valid() const { return std::isfinite(a) && b > 0.0 && a >= b; }

Vec2 Ellipse::position(double t) const { return {a * std::cos(t), b * std::sin(t)}; }

CurveDerivatives Ellipse::derivatives(double t) const {
  const double c = std::cos(t);
  const double s = std::sin(t);
  return {{a * c, b * s}, {-a * s, b * c}, {-a * c, -b * s}, {a * s, -b * c}};
}

LocalGeometry Ellipse::geometry(double t) const {
  const double c = std::cos(t);
  const double s = std::sin(t);
  const double speed2 = a * a * s * s + b * b * c * c;
  return {std::atan2(b * c, -a * s), a * b / (speed2 * std::sqrt(speed2)),          // (20)
          -3.0 * a * b * (a - b) * (a + b) * s * c / (speed2 * speed2 * speed2)};  // (21)
}

Eigen::Matrix<double, 2, 2> Ellipse::position_by_parameters(double t) const {
  Eigen::Matrix<double, 2, 2> m;
  m << std::cos(t), 0.0, 0.0, std::sin(t);
  return m;
}

FootPoint Ellipse::foot_point(const Vec2& point) const {
  double t = first_quadrant_angle(a, b, std::abs(point.x()), std::abs(point.y()));
  t = point.x() < 0.0 ? kPi - t : t;
  t = point.y() < 0.0 ? -t : t;
  return foot_point_at(*this, t, point);
}

double Ellipse::arc_length(double t0, double t1) const {
  return integrate_speed(
      [this](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); }, t0, t1);
}

double Ellipse::parameter_at_arc_length(double t0, double s) const {
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); },
                           [this](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); },
                           t0, s, std::abs(s) / a);
}

ParameterDomain Ellipse::domain() const { return {-kPi, kPi, 2.0 * kPi}; }

std::optional<Localisation> Ellipse::localise(const LocalGeometry& local) const {
  const double focal2 = (a - b) * (a + b);
  if (local.kappa == 0.0 || focal2 == 0.0) {
    return std::nullopt;
  }
  const double cube_root = std::cbrt(a * b / std::abs(local.kappa));
  const double d = cube_root * cube_root;  // squared speed at the point
  const double sin_2t = -2.0 * local.kappa_s * d * d * d / (3.0 * a * b * focal2);
  const double cos_2t = ((a * a + b * b) - 2.0 * d) / focal2;
  return Localisation{0.5 * std::atan2(sin_2t, cos_2t), local.kappa > 0.0};
}

}  // namespace palpate
