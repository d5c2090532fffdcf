#include "tests/paper/finite_differences.h"

#include <cmath>

namespace palpate::paper {
namespace {

/// The parameter beyond t (in the direction of `sign`) at chord length `step_m` from it.
double neighbour(const test::PlacedCurve& curve, double t, double step_m, double sign) {
  const Vec2 origin = test::exact_estimate(curve, t).position;
  const auto chord = [&](double dt) {
    return (test::exact_estimate(curve, t + sign * dt).position - origin).norm();
  };
  double high = 1e-6;
  while (chord(high) < step_m) {
    high *= 2.0;
  }
  double low = 0.5 * high;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (chord(middle) < step_m ? low : high) = middle;
  }
  return t + sign * 0.5 * (low + high);
}

}  // namespace

MeasuredGeometry finite_differences(const test::PlacedCurve& curve, double t, double step) {
  MeasuredGeometry point = measured_geometry(test::exact_estimate(curve, t));
  if (step > 0.0) {
    const double step_m = step / curvature_scale({&point, 1});
    const double before =
        test::exact_estimate(curve, neighbour(curve, t, step_m, -1.0)).tangent_angle;
    const double after =
        test::exact_estimate(curve, neighbour(curve, t, step_m, 1.0)).tangent_angle;
    const double forward = wrap_angle(after - point.tangent_angle);
    const double backward = wrap_angle(before - point.tangent_angle);
    point.kappa = (forward - backward) / (2.0 * step_m);
    point.kappa_s = (forward + backward) / (step_m * step_m);
  }
  return point;
}

}  // namespace palpate::paper
