#include "core/recognition/posterior/class_evidence.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/numerics/negligible.h"
#include "core/numerics/small_cholesky.h"
#include "core/numerics/triangular_root.h"

namespace palpate {
namespace {

/// -log of likelihood times prior.
double potential(const TouchedCurve& curve) { return 0.5 * curve.chi2 - curve.log_prior; }

/// Of what `root` is the root of.
double log_determinant(const TouchedMatrix& root) {
  return 2.0 * root.diagonal().array().log().sum();
}

/// By the coordinates in units of the widths.
TouchedVector prior_gradient(const Touch& touch, const TouchedCurve& curve) {
  return log_prior_gradient(touch.curve_class, curve.z).cwiseProduct(curve.widths);
}

/// The root for a step down the potential, with the curvature that the prior's tails have. From
/// three quarters of a normal law's on, a step by that is nearly as long.
TouchedMatrix step_root(const Touch& touch, const TouchedCurve& curve) {
  const TouchedVector less = TouchedVector::Ones() - tail_weights(touch.curve_class, curve.z);
  if (less.maxCoeff() < 0.25) {
    return curve.root;
  }
  TouchedMatrix curvature = curve.root * curve.root.transpose();
  curvature.diagonal() -= less;
  TouchedMatrix tailed;
  return cholesky(curvature, &tailed) ? tailed : curve.root;
}

/// From the slice beside, the mode is near; from the optimum of the likelihood it may be far, where
/// the data determine little. Bounds of the time: steps end by themselves where the potential is
/// settled, and what is too far for so many is sought from the prior (followed_from_prior).
constexpr int kFewSteps = 4;
constexpr int kMostSteps = 8;

/// Of the potential, where steps end: odds right to a fiftieth.
constexpr double kSettled = 2e-2;

/// Gauss-Newton steps down the potential, coordinate `fixed` staying.
TouchedCurve descend(const Touch& touch, const FitData& data, TouchedCurve curve, int fixed,
                     int most_steps = kFewSteps, double settled = kSettled) {
  double halving = 1.0;
  for (int i = 0; i < most_steps; ++i) {
    // From slice to slice the way is short.
    const TouchedMatrix root = fixed < 0 ? step_root(touch, curve) : root_of(curve, fixed);
    TouchedVector slope = curve.gradient - prior_gradient(touch, curve);
    if (fixed >= 0) {
      slope[fixed] = 0.0;
    }
    const TouchedVector step = solve_cholesky(root, slope);
    if (!(0.5 * halving * slope.dot(step) > settled)) {
      break;
    }
    auto there = curve_at(touch, curve.z - halving * step.cwiseProduct(curve.widths), curve, data);
    if (there && potential(*there) < potential(curve)) {
      curve = std::move(*there);
      halving = std::min(1.0, 2.0 * halving);
    } else {
      halving *= 0.25;
    }
  }
  return curve;
}

/// The curve with coordinate k moved to `value`, the others at their best.
std::optional<TouchedCurve> slice(const Touch& touch, const FitData& data, const TouchedCurve& from,
                                  int k, double value) {
  // The others follow as the linear model says.
  const double moved = (value - from.z[k]) / from.widths[k];
  TouchedVector pull = from.root * from.root.row(k).transpose();
  pull[k] = 0.0;
  TouchedVector step = -moved * solve_cholesky(root_of(from, k), pull);
  step[k] = 0.0;
  for (const double part : {1.0, 0.0}) {
    TouchedVector z = from.z + part * step.cwiseProduct(from.widths);
    z[k] = value;
    if (auto curve = curve_at(touch, z, from, data)) {
      return descend(touch, data, std::move(*curve), k);
    }
  }
  return std::nullopt;
}

/// log of the density at a slice: the others integrated by Laplace's formula, coordinate k in units
/// of its width at the optimum.
double log_density(const TouchedCurve& curve, int k) {
  return -potential(curve) - 0.5 * log_determinant(root_of(curve, k)) - std::log(curve.widths[k]);
}

struct Slice {
  TouchedCurve curve;
  double log_density = 0.0;
};

/// How far a coordinate may be walked: half a turn for directions that come round again.
double longest_walk(CurveClass curve_class, int k) {
  return curve_class == CurveClass::Ellipse && k == 2 ? 0.5 * std::numbers::pi
                                                      : std::numeric_limits<double>::infinity();
}

/// How slices are laid.
struct Walk {
  double step = 0.0;             ///< the first
  double smallest_change = 0.0;  ///< of the log density: after a smaller one the step is doubled
};

/// Slices from `start` (not included) in one direction, until nothing of the `highest` log density
/// seen is left or the class ends.
std::vector<Slice> walk(const Touch& touch, const FitData& data, const Slice& start, int k,
                        double direction, const Walk& how, double* highest) {
  // A normal law ends after four steps of its deviation; a loose coordinate's are doubled.
  constexpr std::size_t kMostSlices = 14;
  constexpr int kMostTries = 20;
  // Of it, from slice to slice: beyond it a shoulder of the density may lie between.
  constexpr double kLargestChange = 2.0;
  const double longest = longest_walk(touch.curve_class, k);
  std::vector<Slice> slices;
  slices.reserve(kMostSlices);
  const Slice* last = &start;
  double& top = *highest;
  double step = direction * how.step;
  for (int tried = 0; tried < kMostTries && slices.size() < kMostSlices; ++tried) {
    const double room = longest - std::abs(last->curve.z[k] - start.curve.z[k]);
    if (!(room > 0.0)) {
      break;
    }
    const double length = std::copysign(std::min(std::abs(step), room), step);
    auto curve = slice(touch, data, last->curve, k, last->curve.z[k] + length);
    if (!curve) {
      step *= 0.5;  // towards the end of the class
      continue;
    }
    const double density = log_density(*curve, k);
    const double change = std::abs(density - last->log_density);
    if (change > kLargestChange && last->log_density > top - 0.5 * kTailOfDensity) {
      step *= 0.5;
      continue;
    }
    slices.push_back({std::move(*curve), density});
    last = &slices.back();
    top = std::max(top, density);
    if (density < top - kTailOfDensity) {
      break;
    }
    if (change < how.smallest_change) {
      step *= 2.0;
    }
  }
  return slices;
}

/// The coordinate of the shape that the data leave the widest, where that is too wide for a normal
/// law; -1 where none is.
int widest_coordinate(const Touch& touch, const TouchedCurve& best, const TouchedMatrix& covariance,
                      const FitData& data, Slices slices) {
  // Coordinates are logarithms, slopes and angles: over a tenth of their unit, the second-order
  // term of a residual is a twentieth of the first.
  constexpr double kLinear = 0.1;
  // A deviation of d bends the curve by some d^2 / 2 of the extent; over the noise of the mean of
  // all points that is how many deviations the narrow coordinates move. A tenth adds a hundredth to
  // their variance.
  constexpr double kLeastBend = 0.1;
  double information = 0.0;
  for (const FitPoint& point : data.points) {
    information += point.inverse_sigma * point.inverse_sigma;
  }
  const double narrow = touch.weight * std::sqrt(information);
  const CurveClass curve_class = touch.curve_class;
  int widest = -1;
  double most = 1.0;
  for (int k = 0; k < shape_coordinates(curve_class); ++k) {
    const double deviation = std::sqrt(covariance(k, k)) * best.widths[k];
    const bool conic = curve_class == CurveClass::Ellipse || curve_class == CurveClass::Hyperbola;
    const bool ends_at_zero =
        (curve_class == CurveClass::CubicSpline && k == 3) || (conic && k == 1);
    double nonlinear = deviation / kLinear;
    // A class ends there (m = 0), or the data resolve the square alone (c of the spline): slices,
    // as far as they go, would come to it.
    if (ends_at_zero && best.z[k] * best.z[k] < 2.0 * kTailOfDensity * deviation * deviation) {
      nonlinear = std::max(nonlinear, 1.0);
    }
    if (slices == Slices::ForMoment) {
      nonlinear = std::max(nonlinear, deviation * deviation * narrow / kLeastBend);
    }
    if (nonlinear >= most) {
      most = nonlinear;
      widest = k;
    }
  }
  return widest;
}

/// log of the integral by Laplace's formula, all coordinates in units of the widths.
double log_mass(const TouchedCurve& mode) {
  return -potential(mode) - 0.5 * log_determinant(mode.root);
}

/// log of the integral over the widest coordinate, by trapezoids between slices, which become the
/// nodes. nullopt where the class is a single slice wide.
std::optional<double> integrate(const FitData& data, const Walk& how, ClassEvidence* evidence) {
  const int k = evidence->widest;
  TouchedCurve mode = evidence->nodes[evidence->mode].curve;
  const double density = log_density(mode, k);
  std::vector<Slice> slices;
  slices.push_back({std::move(mode), density});
  const Slice start = slices.front();
  double top = density;
  std::vector<Slice> behind = walk(evidence->touch, data, start, k, -1.0, how, &top);
  std::vector<Slice> ahead = walk(evidence->touch, data, start, k, 1.0, how, &top);
  const std::size_t middle = behind.size();
  slices.insert(slices.begin(), std::make_move_iterator(behind.rbegin()),
                std::make_move_iterator(behind.rend()));
  slices.insert(slices.end(), std::make_move_iterator(ahead.begin()),
                std::make_move_iterator(ahead.end()));
  const std::size_t n = slices.size();
  std::vector<double> shares(n);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double low = slices[i == 0 ? 0 : i - 1].curve.z[k];
    const double high = slices[i + 1 == n ? i : i + 1].curve.z[k];
    shares[i] = 0.5 * (high - low) * std::exp(slices[i].log_density - top);
    sum += shares[i];
  }
  if (!(sum > 0.0)) {
    return std::nullopt;
  }
  evidence->nodes.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (i == middle) {
      evidence->mode = evidence->nodes.size();
    }
    if (shares[i] > 0.0 || i == middle) {
      evidence->nodes.push_back({std::move(slices[i].curve), shares[i] / sum});
    }
  }
  return top + std::log(sum) - 0.5 * std::log(2.0 * std::numbers::pi);
}

/// The same curve with residuals that count `ratio` times; nullopt where rounding hides its root.
std::optional<TouchedCurve> counted(TouchedCurve curve, double ratio) {
  TouchedMatrix curvature = curve.root * curve.root.transpose();
  curvature.diagonal().array() -= 1.0;
  curvature *= ratio * ratio;
  curvature.diagonal().array() += 1.0;
  curve.chi2 *= ratio * ratio;
  curve.gradient *= ratio * ratio;
  return cholesky(TouchedMatrix(curvature), &curve.root) ? std::optional(std::move(curve))
                                                         : std::nullopt;
}

/// The mode that the prior leads to: from a noise that hides the shape, followed as that is lowered
/// to what it is, as long as it holds more than `log_least`. A fit far out in the prior's tails
/// lies in a valley too narrow and too bent for its noise to be walked along. `start`: its place
/// and feet count.
std::optional<TouchedCurve> followed_from_prior(Touch touch, const FitData& data,
                                                const TouchedCurve& start, double log_least) {
  constexpr double kHidden = 0.1;  // half extents
  // Of the deviation, from level to level: what settles to within half a unit of the potential at
  // one is within four deviations of the next one's valley.
  constexpr double kLevel = 0.25;
  constexpr double kOnTheWay = 0.5;
  constexpr int kStepsPerLevel = 3;  // bounds the time
  const double full = touch.weight;
  touch.weight = std::min(full, rms_sigma(data) / kHidden);
  std::optional<TouchedCurve> curve = curve_at(touch, start.z, start, data);
  while (curve) {
    const bool last = !(touch.weight < full);
    curve = descend(touch, data, *std::move(curve), -1, last ? kMostSteps : kStepsPerLevel,
                    last ? kSettled : kOnTheWay);
    // Less noise leaves no more of it.
    if (!(log_mass(*curve) > log_least)) {
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

/// A prior cannot leave more than all of the likelihood: with that, the fit was no optimum.
bool is_of_optimum(const ClassEvidence& evidence) {
  // As far as chi-square is told of a fit: to 1 by its end on the reduced points (contenders.cpp),
  // and to as much again on the way from it to the mode.
  constexpr double kLeft = 1.0;
  return evidence.log_occam <= kLeft;
}

}  // namespace

TouchedMatrix root_of(const TouchedCurve& curve, int fixed) {
  return fixed < 0 ? curve.root : root_without(curve.root, fixed);
}

std::optional<TouchedCurve> posterior_mode(const CanonicalFit& start, const FitData& data,
                                           double inflation, double least_chi2) {
  // The noise is lowered from what the start leaves to what it is: at each level the valley is wide
  // enough to be walked along.
  constexpr int kStepsPerLevel = 12;
  constexpr double kLevel = 0.5;  // of the deviation
  // At the first level chi-square is the number of points, and where a valley leads to the noise it
  // stays about that. Three levels at which the curve did not come nearer: there is none.
  constexpr double kLost = 64.0;
  const double n = static_cast<double>(residual_count(data));
  // The last level before all of the noise's weight has at least this much of it: what is lost
  // there need not be walked to.
  if (kLevel * kLevel * least_chi2 > kLost * n * inflation) {
    return std::nullopt;
  }
  auto touch = touch_of(start, data);
  if (!touch) {
    return std::nullopt;
  }
  touch->weight = 1.0 / std::sqrt(inflation);
  auto curve = curve_at(*touch, start, data);
  if (!curve) {
    return std::nullopt;
  }
  const double full = touch->weight;
  double weight = full * std::min(1.0, std::sqrt(n / curve->chi2));
  while (weight < full) {
    touch->weight = weight;
    curve = curve_at(*touch, curve->z, *curve, data);
    if (!curve) {
      return std::nullopt;
    }
    curve = descend(*touch, data, *std::move(curve), -1, kStepsPerLevel);
    if (curve->chi2 > kLost * n) {
      return std::nullopt;
    }
    weight /= kLevel;
  }
  touch->weight = full;
  curve = curve_at(*touch, curve->z, *curve, data);
  return curve ? std::optional(descend(*touch, data, *std::move(curve), -1, kMostSteps))
               : std::nullopt;
}

std::optional<ClassEvidence> evidence_of(const CanonicalFit& fit, const FitData& data,
                                         double inflation) {
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
  set_mode(descend(*touch, data, std::move(*first), -1, kMostSteps), &evidence);
  return is_of_optimum(evidence) ? std::optional(std::move(evidence)) : std::nullopt;
}

ClassEvidence with_prior_mode(ClassEvidence evidence, const FitData& data, double least) {
  evidence.prior_mode_sought = true;
  const TouchedCurve fitted = evidence.nodes[evidence.mode].curve;
  const CurveClass curve_class = evidence.touch.curve_class;
  const Touch touch = along_patch(evidence.touch, data);
  const auto take = [&](double arm) {
    const double least_mass = std::max(evidence.log_occam, least) - 0.5 * evidence.fitted_chi2;
    const TouchedCurve start = expected(touch, fitted, arm);
    if (auto mode = followed_from_prior(touch, data, start, least_mass)) {
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

std::optional<ClassEvidence> by_slices(ClassEvidence evidence, const FitData& data,
                                       double inflation, Slices slices) {
  TouchedCurve mode = std::move(evidence.nodes[evidence.mode].curve);
  const double weight = 1.0 / std::sqrt(inflation);
  if (const double ratio = weight / evidence.touch.weight; ratio != 1.0) {
    evidence.touch.weight = weight;
    evidence.fitted_chi2 *= ratio * ratio;
    auto counted = curve_at(evidence.touch, mode.z, mode, data);
    if (!counted) {
      return std::nullopt;
    }
    mode = descend(evidence.touch, data, *std::move(counted), -1, kMostSteps);
  }
  const TouchedMatrix covariance = inverse_cholesky(mode.root);
  const int k = widest_coordinate(evidence.touch, mode, covariance, data, slices);
  double log_integral = log_mass(mode);
  evidence.widest = k;
  evidence.mode = 0;
  evidence.nodes = {{mode, 1.0}};
  if (k >= 0) {
    // A second moment needs finer slices than a mass.
    const double deviation = std::sqrt(covariance(k, k)) * mode.widths[k];
    const Walk how =
        slices == Slices::ForMoment ? Walk{0.5 * deviation, 0.05} : Walk{deviation, 0.5};
    log_integral = integrate(data, how, &evidence).value_or(log_integral);
  }
  evidence.log_occam = log_integral + 0.5 * evidence.fitted_chi2;
  return is_of_optimum(evidence) ? std::optional(std::move(evidence)) : std::nullopt;
}

}  // namespace palpate
