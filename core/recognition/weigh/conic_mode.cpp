#include "core/recognition/weigh/conic_mode.h"

#include <optional>
#include <utility>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/recognition/fit/touchable.h"
#include "core/recognition/posterior/class_evidence.h"

namespace palpate {
namespace {

bool has_optimum(const std::optional<ClassFit>& fit) { return fit && !fit->at_limit; }

/// A circle as an ellipse whose axis points to `direction`.
CanonicalFit as_ellipse(const CanonicalFit& circle, double direction) {
  CanonicalFit ellipse = circle;
  constexpr double kFlattened = 0.9;  // off the ridge that the circle is
  const double radius = circle.shape.values[0];
  ellipse.shape = {CurveClass::Ellipse, {radius / kFlattened, kFlattened * radius, 0.0}};
  ellipse.world_T_curve.theta = circle.world_T_curve.theta + direction;
  for (FittedPoint& point : ellipse.points) {
    point.t -= direction;
  }
  return ellipse;
}

/// A curve of the posterior as a fit to the points. It is no optimum of the likelihood, and is not
/// to be refined to one.
ClassFit as_fit(const TouchedCurve& mode, double inflation) {
  ClassFit fit;
  fit.curve_class = CurveClass::Ellipse;
  fit.chi2 = inflation * mode.chi2;
  fit.weighed = true;
  fit.polished = true;
  fit.implicit.emplace();
  fit.implicit->chi2 = fit.chi2;
  fit.implicit->coefficients =
      conic_of(CurveClass::Ellipse, mode.shape.values, mode.frame_T_curve).normalized();
  const Ellipse ellipse{mode.shape.values[0], mode.shape.values[1]};
  for (const double t : mode.t) {
    fit.implicit->feet.push_back(mode.frame_T_curve * ellipse.derivatives(t).position);
  }
  return fit;
}

}  // namespace

ClassFits with_conic_mode(ClassFits fits, const FitData& reduced, double inflation) {
  auto& ellipse = fits[static_cast<std::size_t>(CurveClass::Ellipse)];
  const auto& circle = fits[static_cast<std::size_t>(CurveClass::Circle)];
  if (has_optimum(ellipse) || has_optimum(fits[static_cast<std::size_t>(CurveClass::Hyperbola)]) ||
      !circle) {
    return fits;
  }
  const auto start = to_canonical(*circle, reduced);
  if (!start) {
    return fits;
  }
  // Half a right angle apart: an ellipse has two valleys, a right angle apart, and ridges between.
  // None along the points' principal axes, where patches across from each other may have a ridge.
  constexpr int kDirections = 4;
  constexpr double kApart = kPi / kDirections;
  const double first = reduced.frame.theta + 0.5 * kApart - start->world_T_curve.theta;
  double least = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const auto mode = posterior_mode(as_ellipse(*start, first + kApart * i), reduced, inflation);
    const double potential = mode ? 0.5 * mode->chi2 - mode->log_prior : 0.0;
    if (!mode || (has_optimum(ellipse) && potential >= least)) {
      continue;
    }
    ClassFit fit = as_fit(*mode, inflation);
    if (is_touchable(*fit.implicit, reduced)) {
      ellipse = std::move(fit);
      least = potential;
    }
  }
  return fits;
}

}  // namespace palpate
