#include "core/curves/circle.h"

#include <cmath>

#include "core/curves/foot_point.h"

namespace palpate {

bool Circle::is_valid() const { return std::isfinite(a) && a > 0.0; }

Vec2 Circle::position(double t) const { return {a * std::cos(t), a * std::sin(t)}; }

CurveDerivatives Circle::derivatives(double t) const {
  const double x = a * std::cos(t);
  const double y = a * std::sin(t);
  return {{x, y}, {-y, x}, {-x, -y}, {y, -x}};
}

LocalGeometry Circle::geometry(double t) const {
  return {std::atan2(std::cos(t), -std::sin(t)), 1.0 / a, 0.0};
}

Eigen::Matrix<double, 2, 1> Circle::position_by_parameters(double t) const {
  return {std::cos(t), std::sin(t)};
}

FootPoint Circle::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  const double t = std::atan2(point.y(), point.x());
  // The inside is left of counterclockwise travel.
  return {t, position(t), a - point.norm()};
}

double Circle::arc_length(double t0, double t1) const { return a * (t1 - t0); }

double Circle::parameter_at_arc_length(double t0, double s) const { return t0 + s / a; }

ParameterDomain Circle::domain() const { return {-kPi, kPi, 2.0 * kPi}; }

std::optional<Localisation> Circle::localise(const LocalGeometry& local) const {
  if (!is_finite(local) || local.kappa == 0.0) {
    return std::nullopt;
  }
  return Localisation{0.0, local.kappa > 0.0};
}

}  // namespace palpate
