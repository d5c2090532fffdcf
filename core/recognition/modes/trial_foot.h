// The foot of a point on a curve that is tried: as near as the point's noise asks for.
#pragma once

#include <cmath>

#include "core/curves/curve.h"

namespace palpate {

/// A point's foot on a curve, and the curve there.
struct TrialFoot {
  double t = 0.0;
  Vec2 position = Vec2::Zero();
  Vec2 first = Vec2::Zero();
};

/// By components, which stay in registers: Eigen's product loads pairs that were just stored apart.
inline double dot(const Vec2& a, const Vec2& b) { return a.x() * b.x() + a.y() * b.y(); }

/// A step of Newton's method on (C - p) . C' = 0.
struct FootStep {
  double by = 0.0;     ///< of the parameter
  double slope = 0.0;  ///< of the left side
};

inline FootStep foot_step(const CurveDerivatives& at, const Vec2& point) {
  const Vec2 away = at.position - point;
  const double speed2 = dot(at.first, at.first);
  const double slope = speed2 + dot(away, at.second);
  // At the centre of curvature the slope is 0; a Gauss-Newton step is safe.
  return {-dot(away, at.first) / (slope > kLeastFootSlope * speed2 ? slope : speed2), slope};
}

/// The step, no longer than leads as far as a foot can be: not farther from where it starts than
/// twice the distance. Beside a cusp, where the curve has hardly any speed, Newton's would leave
/// the data.
inline double within_reach(double step, const CurveDerivatives& at, const Vec2& point) {
  const Vec2 away = at.position - point;
  const double away2 = dot(away, away);
  const double second2 = dot(at.second, at.second);
  const double step2 = step * step;
  const bool is_too_long = step2 * step2 * second2 > 16.0 * away2;  // not if it is no number
  return is_too_long ? std::copysign(std::sqrt(4.0 * std::sqrt(away2 / second2)), step) : step;
}

/// Where a foot is sought: for a conic, whose parameter has no unit of length and changes with the
/// shape, a step from where the point's own coordinates put it, which takes no function of t; for a
/// cubic at `t`, on the arm where it was.
template <typename C>
double near_foot(const C& /*cubic*/, const Vec2& /*point*/, double t) {
  return t;
}

inline double near_foot(const Circle& /*circle*/, const Vec2& point, double t) {
  return t + wrap_angle(std::atan2(point.y(), point.x()) - t);
}

inline double near_foot(const Ellipse& ellipse, const Vec2& point, double t) {
  const auto [a, b] = ellipse;
  const Vec2 unit = Vec2(point.x() / a, point.y() / b).normalized();
  const Vec2 place(a * unit.x(), b * unit.y());
  const double step =
      foot_step({place, {-a * unit.y(), b * unit.x()}, -place, Vec2::Zero()}, point).by;
  const bool at_centre = !std::isfinite(step);
  return t + wrap_angle(std::atan2(unit.y(), unit.x()) + (at_centre ? 0.0 : step) - t);
}

inline double near_foot(const Hyperbola& hyperbola, const Vec2& point, double /*t*/) {
  const auto [a, b] = hyperbola;
  const double s = point.y() / b;
  const double c = std::sqrt(1.0 + s * s);
  const Vec2 place(a * c, b * s);
  return std::asinh(s) + foot_step({place, {a * s, b * c}, place, Vec2::Zero()}, point).by;
}

inline double near_foot(const Parabola& parabola, const Vec2& point, double /*t*/) {
  return point.y() / (2.0 * parabola.a);
}

/// The foot of `point` (curve's frame) by Newton's method: on a conic the one near the point, on a
/// cubic the one near `t`, on the arm where it was. `sigma`: the point's noise. The curve at the
/// end of the last step is told by Taylor's series: it is not asked again.
template <typename C>
TrialFoot trial_foot(const C& curve, const Vec2& point, double t, double sigma) {
  t = near_foot(curve, point, t);
  constexpr int kMostFootSteps = 6;     // digits double from where it is sought
  constexpr double kNegligible = 1e-4;  // of the noise: an error across the curve
  // Of a step, what it leaves: what that leaves out in turn is then a tenth of it.
  constexpr double kConverging = 0.1;
  for (int i = 0;; ++i) {
    const CurveDerivatives at = curve.derivatives(t);
    const auto [newton, slope] = foot_step(at, point);
    const double step = within_reach(newton, at, point);
    if (i == kMostFootSteps || !std::isfinite(step)) {  // as at a cusp, of speed 0
      return {t, at.position, at.first};
    }
    // Newton's method leaves the second-order term of what it sets to 0. Along the curve that is
    // an error; across it, half of its square over the radius of curvature.
    const double step2 = step * step;
    const double left =
        step2 * (1.5 * dot(at.first, at.second) + 0.5 * dot(at.position - point, at.third)) / slope;
    const double bend = 0.5 * left * left * cross(at.first, at.second);
    // A conic's fourth derivative is as long as its second, other classes have none.
    const double series_error = step2 * step2 / 24.0 * std::sqrt(dot(at.second, at.second));
    const double negligible = kNegligible * sigma;
    if (std::abs(left) <= kConverging * std::abs(step) &&
        bend * bend <= negligible * negligible * dot(at.first, at.first) &&
        series_error <= negligible) {
      return {t + step,
              at.position + step * (at.first + step / 2.0 * (at.second + step / 3.0 * at.third)),
              at.first + step * (at.second + step / 2.0 * at.third)};
    }
    t += step;
  }
}

}  // namespace palpate
