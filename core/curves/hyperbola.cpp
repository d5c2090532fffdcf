#include "core/curves/hyperbola.h"

#include <cmath>

#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"
#include "core/curves/sinh_cosh.h"

namespace palpate {

bool Hyperbola::is_valid() const {
  return std::isfinite(a) && std::isfinite(b) && a > 0.0 && b > 0.0;
}

Vec2 Hyperbola::position(double t) const {
  const auto [s, c] = sinh_cosh(t);
  return {a * c, b * s};
}

CurveDerivatives Hyperbola::derivatives(double t) const {
  const auto [s, c] = sinh_cosh(t);
  return {{a * c, b * s}, {a * s, b * c}, {a * c, b * s}, {a * s, b * c}};
}

LocalGeometry Hyperbola::geometry(double t) const {
  const auto [s, c] = sinh_cosh(t);
  const double speed2 = a * a * s * s + b * b * c * c;
  return {std::atan2(b * c, a * s), -a * b / (speed2 * std::sqrt(speed2)),        // (31)
          3.0 * a * b * (a * a + b * b) * (s / speed2) * (c / speed2) / speed2};  // (32)
}

Eigen::Matrix<double, 2, 2> Hyperbola::position_by_parameters(double t) const {
  const auto [s, c] = sinh_cosh(t);
  Eigen::Matrix<double, 2, 2> m;
  m << c, 0.0, 0.0, s;
  return m;
}

FootPoint Hyperbola::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  // (C - p) . C' = 0, divided by (a^2 + b^2) cosh t, with w = sinh t: w - A w / sqrt(1 + w^2) = B.
  // For B >= 0, by symmetry, it has one root w > 0 (or w = 0).
  const double squares = a * a + b * b;
  const double big_a = a * point.x() / squares;
  const double big_b = b * std::abs(point.y()) / squares;
  double w = 0.0;
  if (big_b == 0.0) {
    w = big_a > 1.0 ? std::sqrt((big_a - 1.0) * (big_a + 1.0)) : 0.0;
  } else {
    // A > 0: convex, and Newton's method descends from an upper bound. A <= 0: concave, and it
    // rises from a lower bound. In both cases it never passes the root.
    const double direction = big_a > 0.0 ? -1.0 : 1.0;
    w = big_a > 0.0 ? big_a + big_b : big_b / (1.0 - big_a);
    constexpr int kMostIterations = 100;  // 2/3 per step at worst, near the evolute's cusp
    for (int i = 0; i < kMostIterations; ++i) {
      const double q = 1.0 + w * w;
      const double root = std::sqrt(q);
      const double slope = 1.0 - big_a / (q * root);
      const double step = slope > 0.0 ? -(w - big_a * (w / root) - big_b) / slope : 0.0;
      if (!((w + step - w) * direction > 0.0)) {
        break;
      }
      w += step;
    }
  }
  return foot_point_at(*this, std::copysign(std::asinh(w), point.y()), point);
}

double Hyperbola::speed(double t) const {
  const double s = std::sinh(t);
  return std::sqrt(a * a * (s * s) + b * b * (1.0 + s * s));
}

double Hyperbola::arc_length(double t0, double t1) const {
  // The speed of a slender branch has singularities near the vertex.
  return integrate_speed_by_sides([this](double u) { return speed(u); }, t0, t1, 0.0);
}

double Hyperbola::parameter_at_arc_length(double t0, double s) const {
  const auto speed_at = [this](double u) { return speed(u); };
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed_at, t0, s,
                           1.0);
}

ParameterDomain Hyperbola::domain() const { return kUnbounded; }

std::optional<Localisation> Hyperbola::localise(const LocalGeometry& local) const {
  if (!is_finite(local) || local.kappa == 0.0) {
    return std::nullopt;
  }
  const double cube_root = std::cbrt(a * b / std::abs(local.kappa));
  const double e = cube_root * cube_root;  // squared speed at the point
  const double sinh_2t = 2.0 * local.kappa_s * e * e * e / (3.0 * a * b * (a * a + b * b));
  return finite_place(0.5 * std::asinh(sinh_2t), local.kappa < 0.0);
}

}  // namespace palpate
