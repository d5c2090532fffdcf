#include "core/recognition/posterior/trial_foot.h"

#include <cmath>
#include <variant>

#include "core/curves/pose2.h"

namespace palpate {
namespace {

/// A step of Newton's method on (C - p) . C' = 0.
struct FootStep {
  double by = 0.0;     ///< of the parameter
  double slope = 0.0;  ///< of the left side
};

FootStep foot_step(const CurveDerivatives& at, const Vec2& point) {
  const Vec2 away = at.position - point;
  const double speed2 = at.first.squaredNorm();
  const double slope = speed2 + away.dot(at.second);
  // At the centre of curvature the slope is 0; a Gauss-Newton step is safe.
  return {-away.dot(at.first) / (slope > kLeastFootSlope * speed2 ? slope : speed2), slope};
}

/// Where a foot is sought: for a conic, whose parameter has no unit of length and changes with the
/// shape, a step from where the point's own coordinates put it, which takes no function of t; for a
/// cubic at `t`, on the arm where it was.
double near_foot(const Curve& curve, const Vec2& point, double t) {
  const auto turned = [t](double angle) { return t + wrap_angle(angle - t); };
  if (std::holds_alternative<Circle>(curve)) {
    return turned(std::atan2(point.y(), point.x()));
  }
  if (const auto* ellipse = std::get_if<Ellipse>(&curve)) {
    const auto [a, b] = *ellipse;
    const Vec2 unit = Vec2(point.x() / a, point.y() / b).normalized();
    const Vec2 place(a * unit.x(), b * unit.y());
    const double step =
        foot_step({place, {-a * unit.y(), b * unit.x()}, -place, Vec2::Zero()}, point).by;
    const bool at_centre = !std::isfinite(step);
    return turned(std::atan2(unit.y(), unit.x()) + (at_centre ? 0.0 : step));
  }
  if (const auto* hyperbola = std::get_if<Hyperbola>(&curve)) {
    const auto [a, b] = *hyperbola;
    const double s = point.y() / b;
    const double c = std::sqrt(1.0 + s * s);
    const Vec2 place(a * c, b * s);
    return std::asinh(s) + foot_step({place, {a * s, b * c}, place, Vec2::Zero()}, point).by;
  }
  if (const auto* parabola = std::get_if<Parabola>(&curve)) {
    return point.y() / (2.0 * parabola->a);
  }
  return t;
}

}  // namespace

// By Newton's method. The curve at the end of the last step is told by Taylor's series: it is not
// asked again.
TrialFoot trial_foot(const Curve& curve, const Vec2& point, double t, double sigma) {
  t = near_foot(curve, point, t);
  constexpr int kMostFootSteps = 6;     // digits double from where it is sought
  constexpr double kNegligible = 1e-4;  // of the noise: an error across the curve
  // Of a step, what it leaves: what that leaves out in turn is then a tenth of it.
  constexpr double kConverging = 0.1;
  for (int i = 0;; ++i) {
    const CurveDerivatives at = derivatives(curve, t);
    const auto [step, slope] = foot_step(at, point);
    if (i == kMostFootSteps || !std::isfinite(step)) {  // as at a cusp, of speed 0
      return {t, at.position, at.first};
    }
    // Newton's method leaves the second-order term of what it sets to 0. Along the curve that is
    // an error; across it, half of its square over the radius of curvature.
    const double step2 = step * step;
    const double left =
        step2 * (1.5 * at.first.dot(at.second) + 0.5 * (at.position - point).dot(at.third)) / slope;
    const double bend = 0.5 * left * left * cross(at.first, at.second);
    // A conic's fourth derivative is as long as its second, other classes have none.
    const double series_error = step2 * step2 / 24.0 * at.second.norm();
    const double negligible = kNegligible * sigma;
    if (std::abs(left) <= kConverging * std::abs(step) &&
        bend * bend <= negligible * negligible * at.first.squaredNorm() &&
        series_error <= negligible) {
      return {t + step,
              at.position + step * (at.first + step / 2.0 * (at.second + step / 3.0 * at.third)),
              at.first + step * (at.second + step / 2.0 * at.third)};
    }
    t += step;
  }
}

}  // namespace palpate
