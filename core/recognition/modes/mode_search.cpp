#include "core/recognition/modes/mode_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/matrices/triangular_root.h"
#include "core/recognition/prior/touched_prior.h"

namespace palpate {
namespace {

/// By the coordinates in units of the widths.
TouchedVector prior_gradient(const Touch& touch, const TouchedCurve& curve) {
  return log_prior_gradient(touch.chart(), curve.z).cwiseProduct(curve.widths);
}

/// The root for a step down the potential, with the curvature that the prior's tails have. From
/// three quarters of a normal law's on, a step by that is nearly as long.
TouchedMatrix step_root(const Touch& touch, const TouchedCurve& curve) {
  const TouchedVector less = TouchedVector::Ones() - tail_weights(touch.chart(), curve.z);
  if (less.maxCoeff() < 0.25) {
    return curve.root;
  }
  TouchedMatrix curvature = curve.root * curve.root.transpose();
  curvature.diagonal() -= less;
  TouchedMatrix tailed;
  return cholesky(curvature, &tailed) ? tailed : curve.root;
}

/// The same curve with residuals that count `ratio` times; nullopt where rounding hides its root.
std::optional<TouchedCurve> counted(TouchedCurve curve, double ratio) {
  TouchedMatrix curvature = curve.root * curve.root.transpose();
  curvature.diagonal().array() -= 1.0;
  curvature *= ratio * ratio;
  curvature.diagonal().array() += 1.0;
  curve.chi2 *= ratio * ratio;
  curve.gradient *= ratio * ratio;
  curve.left_to_gain = 0.0;
  return cholesky(TouchedMatrix(curvature), &curve.root) ? std::optional(std::move(curve))
                                                         : std::nullopt;
}

}  // namespace

double potential(const TouchedCurve& curve) { return 0.5 * curve.chi2 - curve.log_prior; }

double log_determinant(const TouchedMatrix& root) {
  return 2.0 * root.diagonal().array().log().sum();
}

TouchedMatrix root_of(const TouchedCurve& curve, int fixed) {
  return fixed < 0 ? curve.root : root_without(curve.root, fixed);
}

double determined_coordinates(const TouchedCurve& settled) {
  return static_cast<double>(kMostCoordinates) - inverse_cholesky(settled.root).trace();
}

double log_mass(const TouchedCurve& settled, int fixed) {
  return settled.left_to_gain - potential(settled) - 0.5 * log_determinant(root_of(settled, fixed));
}

namespace {

/// Where a Gauss-Newton step down the potential leads, coordinate `fixed` (or -1) staying.
struct Step {
  TouchedVector by = TouchedVector::Zero();  ///< in units of the widths
  double gain = 0.0;                         ///< of the potential, as the linear model has it
};

Step step_from(const Touch& touch, const TouchedCurve& curve, int fixed) {
  // From slice to slice the way is short.
  const TouchedMatrix root = fixed < 0 ? step_root(touch, curve) : root_of(curve, fixed);
  TouchedVector slope = curve.gradient - prior_gradient(touch, curve);
  if (fixed >= 0) {
    slope[fixed] = 0.0;
  }
  const TouchedVector by = solve_cholesky(root, slope);
  return {by, 0.5 * slope.dot(by)};
}

/// Back into the valley, where it bends away from a step along it, with the coordinate held that
/// the step moved most: let go, it would move as far again, and as far beside. nullopt where that
/// does not lead below `highest` either. Each step back leaves the square of what there was; one
/// that leaves a fifth is on its way elsewhere.
std::optional<TouchedCurve> corrected(const Touch& touch, const FitData& data, TouchedCurve beside,
                                      int along, double highest, WorkBudget& work) {
  constexpr int kMostSteps = 4;  // digits double
  constexpr double kConverging = 0.2;
  for (int i = 0; i < kMostSteps; ++i) {
    const Step step = step_from(touch, beside, along);
    work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
    auto there = curve_at(touch, beside.z - step.by.cwiseProduct(beside.widths), beside, data);
    if (!there || potential(*there) < highest) {
      return there;
    }
    if (!(potential(*there) - highest < kConverging * (potential(beside) - highest))) {
      break;
    }
    beside = std::move(*there);
  }
  return std::nullopt;
}

}  // namespace

TouchedCurve descend(const Touch& touch, const FitData& data, TouchedCurve curve, int fixed,
                     WorkBudget& work, int most_steps, double settled) {
  // Of a step: where less of one leads down, kStepsFromFit of them gain a twentieth of what is
  // left.
  constexpr double kLeastPart = 0.05;
  double part = 1.0;
  for (int i = 0;; ++i) {
    const Step step = step_from(touch, curve, fixed);
    if (!(step.gain > settled)) {
      curve.left_to_gain = step.gain;
      break;
    }
    if (i == most_steps || !(part * step.gain > settled) || !work.allows()) {
      break;
    }
    work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
    auto there = curve_at(touch, curve.z - part * step.by.cwiseProduct(curve.widths), curve, data);
    if (there && !(potential(*there) < potential(curve)) && fixed < 0) {
      Eigen::Index along = 0;
      step.by.cwiseAbs().maxCoeff(&along);
      there = corrected(touch, data, *std::move(there), static_cast<int>(along), potential(curve),
                        work);
    }
    if (there && potential(*there) < potential(curve)) {
      curve = std::move(*there);
      part = std::min(1.0, 2.0 * part);
    } else {
      part *= 0.25;
    }
    if (part < kLeastPart) {
      break;
    }
  }
  return curve;
}

std::optional<TouchedCurve> followed_from_prior(Touch touch, const FitData& data,
                                                const TouchedCurve& start, double log_least,
                                                WorkBudget& work) {
  // Of the deviation, from level to level: what settles to within half a unit of the potential at
  // one is within four deviations of the next one's valley.
  constexpr double kLevel = 0.25;
  constexpr double kOnTheWay = 0.5;
  constexpr int kStepsPerLevel = 3;  // bounds the time
  const double full = touch.weight;
  work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
  std::optional<TouchedCurve> curve = curve_at(touch, start.z, start, data);
  if (!curve) {
    return std::nullopt;
  }
  // At the first level chi-square is the number of points.
  const double n = static_cast<double>(residual_count(data));
  touch.weight = full * std::min(1.0, std::sqrt(n / curve->chi2));
  curve = counted(*std::move(curve), touch.weight / full);
  while (curve && work.allows()) {
    const bool last = !(touch.weight < full);
    curve = descend(touch, data, *std::move(curve), -1, work, last ? kStepsFromFit : kStepsPerLevel,
                    last ? kSettledPotential : kOnTheWay);
    // What the data determine now, less noise determines the more: by Laplace's formula each such
    // coordinate takes the ratio of the noises.
    const double taken = determined_coordinates(*curve) * std::log(full / touch.weight);
    if (!(log_mass(*curve) - taken > log_least)) {
      return std::nullopt;
    }
    if (last) {
      return curve;
    }
    const double before = touch.weight;
    touch.weight = std::min(full, before / kLevel);
    curve = counted(*std::move(curve), touch.weight / before);
  }
  return std::nullopt;
}

}  // namespace palpate
