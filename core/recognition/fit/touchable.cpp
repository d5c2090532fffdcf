#include "core/recognition/fit/touchable.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Whether all points lie on one branch of a hyperbola: on one side of its conjugate axis.
bool on_one_branch(const ConicCoefficients& q, std::span<const FitPoint> points) {
  const double d = discriminant(q);
  const Vec2 centre((q[1] * q[4] - 2.0 * q[2] * q[3]) / d, (q[1] * q[3] - 2.0 * q[0] * q[4]) / d);
  // Along the real axis the polynomial changes sign from the centre outwards.
  const double at_centre = 0.5 * (q[3] * centre.x() + q[4] * centre.y()) + q[5];
  const double angle = 0.5 * std::atan2(q[1], q[0] - q[2]);
  Vec2 axis(std::cos(angle), std::sin(angle));
  const double curvature_along =
      q[0] * axis.x() * axis.x() + q[1] * axis.x() * axis.y() + q[2] * axis.y() * axis.y();
  if (curvature_along * at_centre > 0.0) {
    axis = left_of(axis);
  }
  bool any_positive = false;
  bool any_negative = false;
  for (const FitPoint& point : points) {
    const double along = (point.position - centre).dot(axis);
    any_positive = any_positive || along > 0.0;
    any_negative = any_negative || along < 0.0;
  }
  return !(any_positive && any_negative);
}

}  // namespace

bool is_touchable(const ImplicitFit& fit, const FitData& data) {
  const ConicCoefficients& q = fit.coefficients;
  if (!(discriminant(q) > 0.0 || on_one_branch(q, data.points))) {
    return false;
  }
  constexpr std::size_t kOneIn = 50;  // points whose own direction noise may turn round
  for (const PatchSpan& patch : data.patches) {
    std::size_t left = 0;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      left += cross(data.points[i].tangent, conic_gradient(q, fit.feet[i])) >= 0.0 ? 1 : 0;
    }
    if (std::min(left, patch.size() - left) * kOneIn > patch.size()) {
      return false;
    }
  }
  return true;
}

bool is_touchable(const PolynomialFit& fit, const FitData& data) {
  constexpr std::size_t kOneIn = 10;  // that noise may turn round on a patch of four sigma
  for (const PatchSpan& patch : data.patches) {
    const std::size_t lag = patch.size() / 2;
    std::size_t forward = 0;
    for (std::size_t i = patch.begin; i + lag < patch.end; ++i) {
      forward += fit.t[i + lag] >= fit.t[i] ? 1 : 0;
    }
    const std::size_t pairs = patch.size() - lag;
    if (std::min(forward, pairs - forward) * kOneIn > pairs) {
      return false;
    }
  }
  return true;
}

}  // namespace palpate
