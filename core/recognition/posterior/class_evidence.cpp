#include "core/recognition/posterior/class_evidence.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/numerics/small_cholesky.h"
#include "core/recognition/posterior/mode_search.h"
#include "core/recognition/posterior/prior_starts.h"

namespace palpate {
namespace {

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

/// The best mode of every arm, by arm_of().
struct ArmMass {
  std::size_t arm = 0;
  double log_mass = 0.0;
};

void keep_best(ArmMass mass, std::vector<ArmMass>* of_arms) {
  const auto same = std::find_if(of_arms->begin(), of_arms->end(),
                                 [&](const ArmMass& other) { return other.arm == mass.arm; });
  if (same == of_arms->end()) {
    of_arms->push_back(mass);
  } else {
    same->log_mass = std::max(same->log_mass, mass.log_mass);
  }
}

void set_log_all_modes(double log_all, ClassEvidence* evidence) {
  evidence->log_all_modes = log_all;
  evidence->log_occam += log_all;
  evidence->log_occam_of_mode += log_all;
}

/// The evidence of the modes that the prior leads to, at the best one, where they have more than
/// `least`, and of the mode that it has, if any.
void take_prior_modes(const Touch& touch, CurveClass path_class, const TouchedCurve& path,
                      const FitData& data, double least, ClassEvidence* evidence,
                      WorkBudget& work) {
  constexpr double kTold = 4.0;  // log: less than a fiftieth of the best is not told
  // log over `least`, e^-9 of the best class: what is left of a fiftieth. A class of less, which
  // the most probable start led to, is not worth the time of others.
  constexpr double kWorthMore = 5.0;
  bool further = false;
  const double half_chi2 = 0.5 * evidence->fitted_chi2;
  std::vector<ArmMass> of_arms;
  double best = -std::numeric_limits<double>::infinity();
  if (!evidence->nodes.empty()) {
    best = log_mass(evidence->nodes[evidence->mode].curve);
    of_arms.push_back(
        {arm_of(touch, evidence->touch, evidence->nodes[evidence->mode].curve.z), best});
  }
  for (const PriorStart& start : prior_starts(touch, path_class, path)) {
    if ((further && !(evidence->log_occam > least + kWorthMore)) || !work.allows()) {
      break;
    }
    further = true;
    auto mode = followed_from_prior(start.touch, data, start.curve,
                                    std::max(best - kTold, least - half_chi2), work);
    if (!mode) {
      continue;
    }
    const double mass = log_mass(*mode);
    keep_best({arm_of(touch, start.touch, mode->z), mass}, &of_arms);
    if (mass > best) {
      best = mass;
      evidence->touch = start.touch;
      set_mode(*std::move(mode), evidence);
    }
  }
  double sum = 0.0;
  for (const ArmMass& arm : of_arms) {
    sum += std::exp(arm.log_mass - best);
  }
  if (sum > 0.0) {
    set_log_all_modes(std::log(sum), evidence);
  }
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
  const CurveClass curve_class = evidence.touch.curve_class;
  const TouchedCurve fitted = evidence.nodes[evidence.mode].curve;
  take_prior_modes(along_patch(evidence.touch, data), curve_class, fitted, data, least, &evidence,
                   work);
  return evidence;
}

std::optional<ClassEvidence> from_prior(ClassEvidence evidence, CurveClass path_class,
                                        const TouchedCurve& path, const FitData& data,
                                        WorkBudget& work) {
  evidence.prior_mode_sought = true;
  take_prior_modes(Touch(evidence.touch), path_class, path, data,
                   -std::numeric_limits<double>::infinity(), &evidence, work);
  return !evidence.nodes.empty() && is_of_optimum(evidence) ? std::optional(std::move(evidence))
                                                            : std::nullopt;
}

ClassEvidence at_better_mode(ClassEvidence evidence, const ClassEvidence& before) {
  evidence.prior_mode_sought = before.prior_mode_sought;
  if (!before.prior_mode_sought) {
    return evidence;
  }
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

}  // namespace palpate
