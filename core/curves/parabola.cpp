#include "core/curves/parabola.h"

#include <cmath>
#include <limits>

#include "core/curves/arc_length.h"
#include "core/curves/polynomial_foot_point.h"

namespace palpate {

bool Parabola::is_valid() const { return std::isfinite(a) && a > 0.0; }

Vec2 Parabola::position(double t) const { return {a * t * t, 2.0 * a * t}; }

CurveDerivatives Parabola::derivatives(double t) const {
  return {{a * t * t, 2.0 * a * t}, {2.0 * a * t, 2.0 * a}, {2.0 * a, 0.0}, {0.0, 0.0}};
}

LocalGeometry Parabola::geometry(double t) const {
  const double q = 1.0 + t * t;
  return {std::atan2(1.0, t), -1.0 / (2.0 * a * q * std::sqrt(q)),  // (14)
          3.0 * t / (4.0 * a * a * q * q * q)};                     // (15)
}

Eigen::Matrix<double, 2, 1> Parabola::position_by_parameters(double t) const {
  return {t * t, 2.0 * t};
}

FootPoint Parabola::foot_point(const Vec2& point) const {
  // (C - p) . C' = 0, over 2 a^2: t^3 + (2 - x/a) t - y/a = 0.
  const Eigen::Vector4d condition(-point.y() / a, 2.0 - point.x() / a, 0.0, 1.0);
  return nearest_foot_point(*this, point,
                            [&](const auto& visit) { visit_roots<3>(condition, visit); });
}

double Parabola::arc_length(double t0, double t1) const {
  return integrate_speed([this](double t) { return 2.0 * a * std::hypot(1.0, t); }, t0, t1);
}

double Parabola::parameter_at_arc_length(double t0, double s) const {
  return invert_arc_length([this](double u, double v) { return arc_length(u, v); },
                           [this](double t) { return 2.0 * a * std::hypot(1.0, t); }, t0, s,
                           std::abs(s) / (2.0 * a * std::hypot(1.0, t0)));
}

ParameterDomain Parabola::domain() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {-kInfinity, kInfinity, 0.0};
}

std::optional<Localisation> Parabola::localise(const LocalGeometry& local) const {
  if (local.kappa == 0.0) {
    return std::nullopt;
  }
  return Localisation{local.kappa_s / (3.0 * local.kappa * local.kappa), local.kappa < 0.0};
}

}  // namespace palpate
