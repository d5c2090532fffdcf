#include "core/recognition/posterior/class_evidence.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/small_cholesky.h"
#include "core/recognition/posterior/mode_search.h"

namespace palpate {
namespace {

/// Place and feet of the curve that the prior expects, touched on the arm of this sign.
TouchedCurve expected(const Touch& touch, const TouchedCurve& like, double arm) {
  constexpr int kBend = 3;  // the coordinate c of the spline
  TouchedCurve start;
  start.z = expected_coordinates(touch.curve_class, arm, like.z[kBend]);
  const auto shape = shape_at(touch.curve_class, start.z, touch.shape);
  start.t.assign(like.t.size(), shape ? shape->t : 0.0);
  return start;
}

/// Laplace's formula at a mode.
void set_mode(TouchedCurve mode, ClassEvidence* evidence) {
  evidence->determined =
      static_cast<double>(kMostCoordinates) - inverse_cholesky(mode.root).trace();
  evidence->log_prior = mode.log_prior;
  evidence->log_occam = log_mass(mode) + 0.5 * evidence->fitted_chi2;
  evidence->log_occam_of_mode = evidence->log_occam;
  const int own = shape_coordinates(evidence->touch.curve_class);
  const Eigen::Matrix<double, 2, kMostCoordinates> touch_rows = mode.root.middleRows<2>(own);
  const Eigen::Matrix2d of_touch = touch_rows * touch_rows.transpose();
  evidence->log_occam_of_touch =
      0.5 * (evidence->fitted_chi2 - mode.chi2 - std::log(of_touch.determinant()));
  evidence->mode = 0;
  evidence->nodes = {{std::move(mode), 1.0}};
}

}  // namespace

bool is_of_optimum(const ClassEvidence& evidence) {
  // As far as chi-square is told of a fit: to 1 by its end on the reduced points (contenders.cpp),
  // and to as much again on the way from it to the mode.
  constexpr double kLeft = 1.0;
  return evidence.log_occam <= kLeft;
}

std::optional<ClassEvidence> evidence_of(const CanonicalFit& fit, const FitData& data,
                                         double inflation, WorkBudget& work) {
  work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
  auto touch = touch_of(fit, data);
  if (!touch) {
    return std::nullopt;
  }
  touch->weight = 1.0 / std::sqrt(inflation);
  auto first = curve_at(*touch, fit, data);
  double fitted_chi2 = 0.0;
  for (const FittedPoint& point : fit.points) {
    fitted_chi2 += point.residual * point.residual + point.normal_residual * point.normal_residual;
  }
  fitted_chi2 /= inflation;
  // Canonical coordinates of a vertex far away lose digits. What is left must still tell the points
  // apart as well as the noise does.
  constexpr double kPartRounding = 1e-3;  // of a chi-square that has no chance
  const double rounding = static_cast<double>(residual_count(data)) + kPartRounding * fitted_chi2;
  if (!first || !(std::abs(first->chi2 - fitted_chi2) <= rounding)) {
    return std::nullopt;
  }
  ClassEvidence evidence;
  evidence.touch = *touch;
  evidence.fitted_chi2 = first->chi2;
  set_mode(descend(*touch, data, std::move(*first), -1, work, kStepsFromFit), &evidence);
  return is_of_optimum(evidence) ? std::optional(std::move(evidence)) : std::nullopt;
}

ClassEvidence with_prior_mode(ClassEvidence evidence, const FitData& data, double least,
                              WorkBudget& work) {
  evidence.prior_mode_sought = true;
  const TouchedCurve fitted = evidence.nodes[evidence.mode].curve;
  const CurveClass curve_class = evidence.touch.curve_class;
  const Touch touch = along_patch(evidence.touch, data);
  const auto take = [&](double arm) {
    const double least_mass = std::max(evidence.log_occam, least) - 0.5 * evidence.fitted_chi2;
    const TouchedCurve start = expected(touch, fitted, arm);
    if (auto mode = followed_from_prior(touch, data, start, least_mass, work)) {
      evidence.touch = touch;
      set_mode(*std::move(mode), &evidence);
    }
  };
  const int place = place_coordinate(curve_class);
  const double arm = place < 0 ? 0.0 : fitted.z[place];
  take(arm);
  if (curve_class == CurveClass::SemiCubicalParabola) {
    take(-arm);  // no way leads over the cusp, which has no tangent
  }
  return evidence;
}

ClassEvidence at_better_mode(ClassEvidence evidence, const ClassEvidence& before) {
  const TouchedCurve& mode = before.nodes[before.mode].curve;
  evidence.prior_mode_sought = before.prior_mode_sought;
  if (before.prior_mode_sought && before.nodes.size() == 1 &&
      log_mass(mode) > log_mass(evidence.nodes[evidence.mode].curve)) {
    evidence.touch = before.touch;
    set_mode(mode, &evidence);
  }
  return evidence;
}

}  // namespace palpate
