#include "core/recognition/weigh/conic_mode.h"

#include <optional>
#include <utility>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/recognition/fit/touchable.h"
#include "core/recognition/posterior/mode_search.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {
namespace {

bool has_optimum(const std::optional<ClassFit>& fit) { return fit && !fit->at_limit; }

/// A circle as an ellipse whose axis points to `direction`.
CanonicalFit as_ellipse(const CanonicalFit& circle, double direction) {
  CanonicalFit ellipse = circle;
  // Off the ridge that the circle is, where no direction is downhill, and no farther than steps are
  // linear (class_evidence.cpp): by a tenth.
  constexpr double kFlattened = 0.9;
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

Contenders with_conic_mode(Contenders contenders, const EvidenceContext& context,
                           unsigned classes) {
  constexpr auto kEllipse = static_cast<std::size_t>(CurveClass::Ellipse);
  constexpr auto kHyperbola = static_cast<std::size_t>(CurveClass::Hyperbola);
  const FitData& reduced = context.reduced;
  const double inflation = context.likelihood.inflation();
  const auto& line = contenders.coarse[static_cast<std::size_t>(CurveClass::Line)];
  const auto& circle = contenders.coarse[static_cast<std::size_t>(CurveClass::Circle)];
  const bool wanted =
      (classes & (1U << kEllipse)) != 0 &&
      static_cast<int>(residual_count(context.arcs.data)) > degrees_of_freedom(CurveClass::Ellipse);
  const bool has_conic =
      has_optimum(contenders.coarse[kEllipse]) || has_optimum(contenders.coarse[kHyperbola]);
  if (!wanted || has_conic || contenders.no_conic || !circle ||
      (line && fits_well(line->chi2 / inflation, residual_count(reduced)))) {
    return contenders;
  }
  const auto start = to_canonical(*circle, reduced);
  if (!start) {
    return contenders;
  }
  // Half a right angle apart: an ellipse has two valleys, a right angle apart, and ridges between.
  // None along the points' principal axes, where patches across from each other may have a ridge.
  constexpr int kDirections = 4;
  constexpr double kApart = kPi / kDirections;
  const auto& ellipse = contenders.coarse[kEllipse];
  const double least_chi2 = ellipse ? ellipse->least_chi2 : 0.0;
  const double first = reduced.frame.theta + 0.5 * kApart - start->world_T_curve.theta;
  std::optional<ClassFit> best;
  double least = 0.0;
  for (int i = 0; i < kDirections && context.work.allows(); ++i) {
    const auto mode = posterior_mode(as_ellipse(*start, first + kApart * i), reduced, inflation,
                                     least_chi2, context.work);
    const double potential = mode ? 0.5 * mode->chi2 - mode->log_prior : 0.0;
    if (!mode || (best && potential >= least)) {
      continue;
    }
    ClassFit fit = as_fit(*mode, inflation);
    if (is_touchable(*fit.implicit, reduced)) {
      best = std::move(fit);
      least = potential;
    }
  }
  if (best) {
    contenders.fits[kEllipse] = best;
    contenders.fits[kEllipse]->chi2 += context.arcs.smooth.chi2;
    contenders.coarse[kEllipse] = std::move(best);
    contenders.evidences =
        evidences_of(contenders.fits, contenders.coarse, context.arcs.smooth, reduced,
                     context.likelihood, std::move(contenders.evidences), context.work);
  }
  contenders.no_conic = !contenders.evidences.classes[kEllipse] &&
                        !has_straight_paths(contenders.evidences, CurveClass::Ellipse);
  return contenders;
}

}  // namespace palpate
