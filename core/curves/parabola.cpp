#include "core/curves/parabola.h"

#include <algorithm>
#include <cmath>

#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"

namespace palpate {

bool Parabola::is_valid() const { return std::isfinite(a) && a > 0.0; }

LocalGeometry Parabola::geometry(double t) const {
  const double q = 1.0 + t * t;
  return {std::atan2(1.0, t), -1.0 / (2.0 * a * q * std::sqrt(q)),  // (14)
          3.0 * t / (4.0 * a * a * q * q * q)};                     // (15)
}

Eigen::Matrix<double, 2, 1> Parabola::position_by_parameters(double t) const {
  return {t * t, 2.0 * t};
}

FootPoint Parabola::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  // (C - p) . C' = 0, divided by 2 a^2: t^3 + p t - q = 0. For q >= 0, by symmetry, it has one root
  // t > 0 (or t = 0). The cubic is convex there: from above Newton's method descends to the root
  // and never passes it.
  const double p = 2.0 - point.x() / a;
  const double q = std::abs(point.y()) / a;
  double t = std::cbrt(q) + (p < 0.0 ? std::sqrt(-p) : 0.0);
  if (p > 0.0) {
    t = std::min(t, q / p);
  }
  constexpr int kMostIterations = 100;  // 2/3 per step at worst, near the evolute's cusp
  for (int i = 0; i < kMostIterations; ++i) {
    const double slope = 3.0 * t * t + p;
    const double next = slope > 0.0 ? t - ((t * t + p) * t - q) / slope : t;
    if (!(next < t)) {
      break;
    }
    t = next;
  }
  return foot_point_at(*this, std::copysign(t, point.y()), point);
}

double Parabola::arc_length(double t0, double t1) const {
  // a (t sqrt(1 + t^2) + asinh t); the difference is computed so that short arcs keep their digits.
  const double q0 = std::hypot(1.0, t0);
  const double q1 = std::hypot(1.0, t1);
  if (t0 * t1 <= 0.0) {
    return a * ((t1 * q1 - t0 * q0) + (std::asinh(t1) - std::asinh(t0)));
  }
  const double squares = (t1 - t0) * (t1 + t0);
  return a * (squares * (1.0 + t0 * t0 + t1 * t1) / (t1 * q1 + t0 * q0) +
              std::asinh(squares / (t1 * q0 + t0 * q1)));
}

double Parabola::parameter_at_arc_length(double t0, double s) const {
  const auto speed = [this](double t) { return 2.0 * a * std::hypot(1.0, t); };
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); }, speed, t0, s,
                           1.0);
}

ParameterDomain Parabola::domain() const { return kUnbounded; }

std::optional<Localisation> Parabola::localise(const LocalGeometry& local) const {
  if (!is_finite(local) || local.kappa == 0.0) {
    return std::nullopt;
  }
  return finite_place(local.kappa_s / (3.0 * local.kappa * local.kappa), local.kappa < 0.0);
}

}  // namespace palpate
