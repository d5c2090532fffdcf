#include "core/curves/line.h"

#include <cmath>

#include "core/curves/foot_point.h"

namespace palpate {

bool Line::is_valid() const { return true; }

Vec2 Line::position(double t) const { return {t, 0.0}; }

CurveDerivatives Line::derivatives(double t) const {
  return {{t, 0.0}, {1.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
}

LocalGeometry Line::geometry(double) const { return {0.0, 0.0, 0.0}; }

Eigen::Matrix<double, 2, 0> Line::position_by_parameters(double) const { return {}; }

FootPoint Line::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  return {point.x(), {point.x(), 0.0}, point.y()};
}

double Line::arc_length(double t0, double t1) const { return t1 - t0; }

double Line::parameter_at_arc_length(double t0, double s) const { return t0 + s; }

ParameterDomain Line::domain() const { return kUnbounded; }

std::optional<Localisation> Line::localise(const LocalGeometry& local) const {
  if (!is_finite(local)) {
    return std::nullopt;
  }
  return Localisation{0.0, true};
}

}  // namespace palpate
