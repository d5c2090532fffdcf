#include "core/recognition/modes/class_evidence.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/probability/log_add.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/modes/mode_search.h"
#include "core/recognition/modes/touched_arc.h"
#include "core/recognition/prior/arc_coordinates.h"
#include "core/recognition/prior/touched_prior.h"

namespace palpate {
namespace {

/// The fit in touched coordinates; nullopt if it has none.
std::optional<TouchedCurve> placed(const Touch& touch, const CanonicalFit& fit, const FitData& data,
                                   WorkBudget& work) {
  work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
  return curve_at(touch, fit, data);
}

/// Whether touched coordinates hold the fit. Those of a vertex far away lose digits. What is left
/// must still tell the points apart as well as the noise does.
bool holds(const TouchedCurve& curve, double fitted_chi2, const FitData& data) {
  constexpr double kPartRounding = 1e-3;  // of a chi-square that has no chance
  const double rounding = static_cast<double>(residual_count(data)) + kPartRounding * fitted_chi2;
  return std::abs(curve.chi2 - fitted_chi2) <= rounding;
}

/// As far as chi-square is told of a fit: to 1 by its end on the reduced points (contenders.cpp),
/// and to as much again on the way from it to the mode.
constexpr double kToldChi2 = 1.0;

/// Whether they hold it so well that evidence can be told from there. Of a spline that they do not,
/// an arc's are left.
bool holds_closely(const TouchedCurve& spline, double fitted_chi2) {
  return std::abs(spline.chi2 - fitted_chi2) <= kToldChi2;
}

/// Whether the data tell the sign of a spline's c, and not only its square.
bool tells_bend(const TouchedCurve& spline) {
  constexpr int kBend = 3;  // the coordinate c
  const double deviation =
      std::sqrt(inverse_cholesky(spline.root)(kBend, kBend)) * spline.widths[kBend];
  return spline.z[kBend] * spline.z[kBend] > 2.0 * kTailOfDensity * deviation * deviation;
}

/// log of the density that the half of the spline's prior that is one of arcs has at z over the
/// other half's, both by the other half's coordinates; -infinity where no spline is.
double log_ratio_of_arcs(const Touch& touch, const TouchedVector& z) {
  constexpr double kStep = 1e-6;  // of a coordinate, by central differences
  const auto arc_at = [&](const TouchedVector& at) {
    TouchedVector arc = TouchedVector::Zero();
    if (const auto shape = shape_at(touch.chart(), at, touch.shape)) {
      arc.head<4>() = arc_coordinates_of(*shape);
    }
    return arc;
  };
  Eigen::Matrix4d by_coordinate;
  for (int k = 0; k < 4; ++k) {
    const double step = kStep * std::max(std::abs(z[k]), kStep);
    TouchedVector ahead = z;
    TouchedVector behind = z;
    ahead[k] += step;
    behind[k] -= step;
    by_coordinate.col(k) = (arc_at(ahead) - arc_at(behind)).head<4>() / (2.0 * step);
  }
  const double ratio = log_density({touch.curve_class, true}, arc_at(z)) +
                       std::log(std::abs(by_coordinate.determinant())) -
                       log_density(touch.chart(), z);
  return std::isfinite(ratio) ? ratio : -std::numeric_limits<double>::infinity();
}

/// The least of it about a mode, two deviations along each coordinate: next to a cusp, which no arc
/// is, it runs to infinity. -infinity where the descent has not settled, or the data leave place or
/// bend so wide that the other half's own mode is elsewhere.
double least_log_ratio_of_arcs(const Touch& touch, const TouchedCurve& mode) {
  constexpr double kDeviations = 2.0;
  constexpr double kWide = 0.1;  // of the prior's width
  const TouchedMatrix covariance = inverse_cholesky(mode.root);
  double least = -std::numeric_limits<double>::infinity();
  if (!(mode.left_to_gain > 0.0) || covariance(2, 2) > kWide * kWide ||
      covariance(3, 3) > kWide * kWide) {
    return least;
  }
  least = log_ratio_of_arcs(touch, mode.z);
  for (int k = 0; k < 4 && least > -kToldMass; ++k) {
    const TouchedVector by =
        kDeviations / std::sqrt(covariance(k, k)) * covariance.col(k).cwiseProduct(mode.widths);
    least = std::min(
        {least, log_ratio_of_arcs(touch, mode.z + by), log_ratio_of_arcs(touch, mode.z - by)});
  }
  return least;
}

/// A spline's fit as an arc. nullopt if that does not hold it.
std::optional<TouchedArc> placed_arc(const CanonicalFit& fit, double fitted_chi2, double weight,
                                     const FitData& data, WorkBudget& work) {
  auto arc = arc_of(fit, data);
  if (!arc) {
    return std::nullopt;
  }
  arc->touch.weight = weight;
  work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
  auto curve = curve_at(arc->touch, arc->curve.z, arc->curve, data);
  if (!curve || !holds(*curve, fitted_chi2, data)) {
    return std::nullopt;
  }
  arc->curve = *std::move(curve);
  return arc;
}

/// The evidence of a spline's fit as an arc alone: the other half of its prior, in which the vertex
/// is farther away than double precision holds it, has none.
std::optional<ClassEvidence> evidence_of_arc(const CanonicalFit& fit, const FitData& data,
                                             double inflation, WorkBudget& work) {
  auto arc = placed_arc(fit, chi2_of(fit) / inflation, 1.0 / std::sqrt(inflation), data, work);
  if (!arc) {
    return std::nullopt;
  }
  ClassEvidence evidence;
  evidence.touch = arc->touch;
  evidence.fitted_chi2 = arc->curve.chi2;
  set_mode(descend(arc->touch, data, std::move(arc->curve), -1, work, kStepsFromFit), &evidence);
  return is_of_optimum(evidence) ? std::optional(std::move(evidence)) : std::nullopt;
}

/// The half of the spline's prior that is one of arcs: the mode there of the same fit.
/// False if arc coordinates do not hold it.
bool add_arc(const CanonicalFit& fit, const FitData& data, ClassEvidence* evidence,
             WorkBudget& work) {
  auto arc = placed_arc(fit, evidence->fitted_chi2, evidence->touch.weight, data, work);
  if (!arc) {
    return false;
  }
  const Touch& touch = arc->touch;
  std::optional<TouchedCurve> curve =
      descend(touch, data, std::move(arc->curve), -1, work, kStepsFromFit);
  const double from_vertex = log_mass(evidence->nodes[evidence->mode].curve);
  const double as_arc = log_mass(*curve);
  if (as_arc > from_vertex) {
    evidence->touch = touch;
    set_mode(*std::move(curve), evidence);
  }
  set_log_all_modes(std::log1p(std::exp(-std::abs(as_arc - from_vertex))), evidence);
  return true;
}

}  // namespace

void set_mode(TouchedCurve mode, ClassEvidence* evidence) {
  evidence->determined = determined_coordinates(mode);
  evidence->log_prior = mode.log_prior;
  evidence->log_occam = log_mass(mode) + 0.5 * evidence->fitted_chi2;
  evidence->log_all_modes = 0.0;
  const int own = shape_coordinates(evidence->touch.curve_class);
  const Eigen::Matrix<double, 2, kMostCoordinates> touch_rows = mode.root.middleRows<2>(own);
  const Eigen::Matrix2d of_touch = touch_rows * touch_rows.transpose();
  evidence->log_occam_of_touch =
      0.5 * (evidence->fitted_chi2 - mode.chi2 - std::log(of_touch.determinant()));
  evidence->mode = 0;
  evidence->widest = -1;
  evidence->nodes = {{std::move(mode), 1.0}};
}

void set_log_all_modes(double log_all, ClassEvidence* evidence) {
  const double more = log_all - evidence->log_all_modes;
  evidence->log_all_modes = log_all;
  evidence->log_occam += more;
}

bool is_of_optimum(const ClassEvidence& evidence) { return evidence.log_occam <= kToldChi2; }

double fall_to_mode(const ClassEvidence& evidence) {
  return evidence.nodes.empty()
             ? 0.0
             : std::max(evidence.fitted_chi2 - evidence.nodes[evidence.mode].curve.chi2, 0.0);
}

std::optional<ClassEvidence> evidence_of(const CanonicalFit& fit, const FitData& data,
                                         double inflation, WorkBudget& work) {
  auto touch = touch_of(fit, data);
  std::optional<TouchedCurve> first;
  if (touch) {
    touch->weight = 1.0 / std::sqrt(inflation);
    first = placed(*touch, fit, data, work);
  }
  const double fitted_chi2 = chi2_of(fit) / inflation;
  const bool is_held = first && holds(*first, fitted_chi2, data);
  if (!is_held || (fit.polynomial && !holds_closely(*first, fitted_chi2))) {
    auto of_arc = evidence_of_arc(fit, data, inflation, work);
    if (of_arc || !is_held) {
      return of_arc;
    }
  }
  ClassEvidence evidence;
  evidence.touch = *touch;
  evidence.fitted_chi2 = first->chi2;
  const TouchedVector z = first->z;
  set_mode(descend(*touch, data, std::move(*first), -1, work, kStepsFromFit), &evidence);
  if (touch->curve_class == CurveClass::CubicSpline) {
    const TouchedCurve& mode = evidence.nodes[evidence.mode].curve;
    const bool is_linear = is_seen_as_arc(z[2], z[3]) || tells_bend(mode);
    const bool is_added = is_linear && add_arc(fit, data, &evidence, work);
    if (!is_added) {
      set_log_all_modes(log_add(0.0, least_log_ratio_of_arcs(*touch, mode)), &evidence);
    }
  }
  return is_of_optimum(evidence) ? std::optional(std::move(evidence)) : std::nullopt;
}

std::optional<ClassEvidence> at_mode(const CanonicalFit& start, bool as_arc, double fitted_chi2,
                                     const FitData& data, double inflation, WorkBudget& work) {
  auto touch = touch_of(start, data);
  if (!touch) {
    return std::nullopt;
  }
  touch->as_arc = as_arc;
  touch->weight = 1.0 / std::sqrt(inflation);
  auto curve = placed(*touch, start, data, work);
  if (!curve) {
    return std::nullopt;
  }
  ClassEvidence evidence;
  evidence.touch = *touch;
  evidence.fitted_chi2 = fitted_chi2;
  set_mode(descend(*touch, data, *std::move(curve), -1, work, kStepsFromFit), &evidence);
  return evidence;
}

ClassEvidence at_better_mode(ClassEvidence evidence, const ClassEvidence& before) {
  evidence.prior_mode_sought = before.prior_mode_sought;
  const TouchedCurve& mode = before.nodes[before.mode].curve;
  const double others = std::expm1(before.log_all_modes);  // over what that mode has
  const double gain = log_mass(mode) - log_mass(evidence.nodes[evidence.mode].curve);
  if (gain > 0.0) {
    evidence.touch = before.touch;
    set_mode(mode, &evidence);
  }
  set_log_all_modes(std::log1p(others * std::exp(std::min(gain, 0.0))), &evidence);
  return evidence;
}

ClassEvidence counted_from(double fitted_chi2, ClassEvidence evidence) {
  const double log_all_modes = evidence.log_all_modes;
  evidence.fitted_chi2 = fitted_chi2;
  set_mode(TouchedCurve(evidence.nodes[evidence.mode].curve), &evidence);
  set_log_all_modes(log_all_modes, &evidence);
  return evidence;
}

}  // namespace palpate
