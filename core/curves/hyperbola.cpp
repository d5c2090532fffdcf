#include "core/curves/hyperbola.h"

#include <cmath>
#include <limits>

#include "core/curves/arc_length.h"
#include "core/curves/polynomial_foot_point.h"

namespace palpate {

bool Hyperbola::is_valid() const {
  return std::isfinite(a) && std::isfinite(b) && a > 0.0 && b > 0.0;
}

Vec2 Hyperbola::position(double t) const { return {a * std::cosh(t), b * std::sinh(t)}; }

CurveDerivatives Hyperbola::derivatives(double t) const {
  const double c = std::cosh(t);
  const double s = std::sinh(t);
  return {{a * c, b * s}, {a * s, b * c}, {a * c, b * s}, {a * s, b * c}};
}

LocalGeometry Hyperbola::geometry(double t) const {
  const double c = std::cosh(t);
  const double s = std::sinh(t);
  const double speed2 = a * a * s * s + b * b * c * c;
  return {std::atan2(b * c, a * s), -a * b / (speed2 * std::sqrt(speed2)),             // (31)
          3.0 * a * b * (a * a + b * b) * s * c / (speed2 * speed2 * speed2)};  // (32)
}

Eigen::Matrix<double, 2, 2> Hyperbola::position_by_parameters(double t) const {
  Eigen::Matrix<double, 2, 2> m;
  m << std::cosh(t), 0.0, 0.0, std::sinh(t);
  return m;
}

FootPoint Hyperbola::foot_point(const Vec2& point) const {
  // (C - p) . C' = 0 with u = exp(t), times 4 u^2:
  // (a^2 + b^2)(u^4 - 1) - 2 a x (u^3 - u) - 2 b y (u^3 + u) = 0.
  const double squares = a * a + b * b;
  const double ax = 2.0 * a * point.x();
  const double by = 2.0 * b * point.y();
  Eigen::Matrix<double, 5, 1> condition;
  condition << -squares, ax - by, 0.0, -ax - by, squares;
  return nearest_foot_point(*this, point, [&](const auto& visit) {
    visit_roots<4>(condition, [&](double u) {
      if (u > 0.0 && std::isfinite(u)) {
        visit(std::log(u));
      }
    });
  });
}

double Hyperbola::arc_length(double t0, double t1) const {
  return integrate_speed(
      [this](double t) { return std::hypot(a * std::sinh(t), b * std::cosh(t)); }, t0, t1);
}

double Hyperbola::parameter_at_arc_length(double t0, double s) const {
  const auto speed = [this](double t) { return std::hypot(a * std::sinh(t), b * std::cosh(t)); };
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed, t0, s,
                           std::min(std::abs(s) / speed(t0), 1.0));
}

ParameterDomain Hyperbola::domain() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {-kInfinity, kInfinity, 0.0};
}

std::optional<Localisation> Hyperbola::localise(const LocalGeometry& local) const {
  if (local.kappa == 0.0) {
    return std::nullopt;
  }
  const double cube_root = std::cbrt(a * b / std::abs(local.kappa));
  const double e = cube_root * cube_root;  // squared speed at the point
  const double sinh_2t = 2.0 * local.kappa_s * e * e * e / (3.0 * a * b * (a * a + b * b));
  return Localisation{0.5 * std::asinh(sinh_2t), local.kappa < 0.0};
}

}  // namespace palpate
