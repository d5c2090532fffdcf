#include "core/recognition/modes/slices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/modes/mode_search.h"

namespace palpate {
namespace {

/// How the other coordinates follow coordinate k along the valley, as the linear model says.
TouchedVector valley_slope(const TouchedCurve& curve, int k) {
  TouchedVector pull = curve.root * curve.root.row(k).transpose();
  pull[k] = 0.0;
  TouchedVector slope = -solve_cholesky(root_of(curve, k), pull).cwiseProduct(curve.widths);
  slope /= curve.widths[k];
  slope[k] = 1.0;
  return slope;
}

/// The valley at a curve of it, by coordinate k.
struct Valley {
  TouchedVector slope;
  TouchedVector bend = TouchedVector::Zero();  ///< derivative of `slope`
};

/// The curve with coordinate k moved by `by`, the others at their best. `valley`: at `from`.
std::optional<TouchedCurve> slice(const Touch& touch, const FitData& data, const TouchedCurve& from,
                                  int k, double by, const Valley& valley, double settled,
                                  WorkBudget& work) {
  const TouchedVector z = from.z + by * (valley.slope + 0.5 * by * valley.bend);
  work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
  auto beside = curve_at(touch, z, from, data);
  if (!beside) {
    return std::nullopt;
  }
  return descend(touch, data, *std::move(beside), k, work, kStepsFromBeside, settled);
}

/// log of the density at a slice: the others integrated by Laplace's formula, coordinate k in units
/// of its width at the optimum.
double log_density(const TouchedCurve& curve, int k) {
  return log_mass(curve, k) - std::log(curve.widths[k]);
}

struct Slice {
  TouchedCurve curve;
  double log_density = 0.0;
};

/// How far a coordinate may be walked from `z`: half a turn for directions that come round again,
/// and to the parabola, where conics end.
double longest_walk(CurveClass curve_class, int k, double z, double direction) {
  constexpr double kLeastM = 1e-9;  // a conic of m = 0 is no other than the parabola
  const bool conic = curve_class == CurveClass::Ellipse || curve_class == CurveClass::Hyperbola;
  if (conic && k == 1 && direction < 0.0) {
    return z - kLeastM;
  }
  return curve_class == CurveClass::Ellipse && k == 2 ? 0.5 * std::numbers::pi
                                                      : std::numeric_limits<double>::infinity();
}

/// How slices are laid. Lengths are in deviations of a normal law that falls as far from its
/// highest density: what falls faster or slower has its slices closer or farther apart.
struct Walk {
  double apart = 0.0;
  double end = 0.0;         ///< from the highest density
  double settled = 0.0;     ///< descend()'s
  bool both_sides = false;  ///< of the mode are asked for
};

/// Sums of a normal law's density this far apart are off by 2 exp(-2 pi^2 / apart^2), half a
/// thousandth. Two of them pass three deviations, beyond which it has 0.3 % of its mass: what odds
/// are told to is seven times that (kSettledPotential).
constexpr Walk kWalkForMass{1.55, 3.0, kSettledPotential, false};

/// Of its second moment a normal law has 0.3 % beyond the end.
constexpr Walk kWalkForMoment{1.0, 3.75, kSettledPlace, true};

/// How far from its highest density a normal law has fallen from one to the other.
double deviations_below(double highest, double log_density) {
  return std::sqrt(2.0 * std::max(highest - log_density, 0.0));
}

/// Slices from `start` (not included) in one direction, until nothing of the `highest` log density
/// seen is left or the class ends. `deviation`: of coordinate k at `start`; its sign is the
/// direction.
std::vector<Slice> walk(const Touch& touch, const FitData& data, const Slice& start, int k,
                        double deviation, const Walk& how, double* highest, WorkBudget& work) {
  // Four are enough for a normal law; a loose coordinate's steps are doubled.
  constexpr std::size_t kMostSlices = 14;
  constexpr int kMostTries = 20;
  // Of `apart`: beyond it a shoulder of the density may lie between, which matters from where a
  // tenth of the highest is left.
  constexpr double kTooFar = 1.25;
  constexpr double kTenth = 2.15;
  // Of a step that went too far: where the valley bends, slices lie beside it by the square of the
  // step, unless they were lost on the way.
  constexpr double kLeastShrink = 0.125;
  // Of the first step: what is left to the end of the class has less than a tenth of the mass.
  constexpr double kLeastRoom = 0.125;
  const double longest = longest_walk(touch.curve_class, k, start.curve.z[k], deviation);
  std::vector<Slice> slices;
  slices.reserve(kMostSlices);
  const Slice* last = &start;
  Valley valley{valley_slope(start.curve, k)};
  double outside = std::numeric_limits<double>::infinity();  // where the class has no slice
  double step = how.apart * deviation;
  for (int tried = 0; tried < kMostTries && slices.size() < kMostSlices; ++tried) {
    const double walked = std::abs(last->curve.z[k] - start.curve.z[k]);
    const double room = std::min(longest - walked, 0.5 * (outside - walked));
    if (!(room > kLeastRoom * how.apart * std::abs(deviation)) || !work.allows()) {
      break;
    }
    const double length = std::copysign(std::min(std::abs(step), room), step);
    auto curve = slice(touch, data, last->curve, k, length, valley, how.settled, work);
    const double density = curve ? log_density(*curve, k) : 0.0;
    if (!curve || !std::isfinite(density)) {
      outside = walked + std::abs(length);
      continue;
    }
    const double top = std::max(*highest, density);
    const double before = deviations_below(top, last->log_density);
    const double here = deviations_below(top, density);
    const double apart = std::abs(here - before);
    if (apart > kTooFar * how.apart && before < kTenth) {
      step *= std::clamp(std::sqrt(how.apart / apart), kLeastShrink, 0.5);
      continue;
    }
    const TouchedVector slope = valley_slope(*curve, k);
    valley = {slope, (slope - valley.slope) / length};
    slices.push_back({std::move(*curve), density});
    last = &slices.back();
    *highest = top;
    if (here > how.end) {
      break;
    }
    if (apart < 0.5 * how.apart) {
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
        (curve_class == CurveClass::CubicSpline && !touch.as_arc && k == 3) || (conic && k == 1);
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

/// log of the integral over the widest coordinate, by trapezoids between slices, which become the
/// nodes. nullopt where the class is a single slice wide; for a moment also where there is no
/// valley to walk along on one side of the mode, though the class does not end there: feet leap
/// from arm to arm, and slices beside the mode are of another. `deviation`: of that coordinate at
/// the mode.
std::optional<double> integrate(const FitData& data, double deviation, const Walk& how,
                                ClassEvidence* evidence, WorkBudget& work) {
  const int k = evidence->widest;
  TouchedCurve mode = evidence->nodes[evidence->mode].curve;
  const double density = log_density(mode, k);
  std::vector<Slice> slices;
  slices.push_back({std::move(mode), density});
  const Slice start = slices.front();
  double top = density;
  std::vector<Slice> behind = walk(evidence->touch, data, start, k, -deviation, how, &top, work);
  std::vector<Slice> ahead = walk(evidence->touch, data, start, k, deviation, how, &top, work);
  const auto is_lost = [&](const std::vector<Slice>& side, double direction) {
    return side.empty() &&
           std::isinf(longest_walk(evidence->touch.curve_class, k, start.curve.z[k], direction));
  };
  if (how.both_sides && (is_lost(behind, -1.0) || is_lost(ahead, 1.0))) {
    return std::nullopt;
  }
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

/// Whether the slice where the sliced coordinate is that of `other` is the curve of `other`, and
/// not one of another valley.
bool runs_through(const ClassEvidence& sliced, const TouchedVector& other, const FitData& data,
                  WorkBudget& work) {
  const int k = sliced.widest;
  const auto nearest =
      std::min_element(sliced.nodes.begin(), sliced.nodes.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.curve.z[k] - other[k]) < std::abs(b.curve.z[k] - other[k]);
      });
  const TouchedCurve& beside = nearest->curve;
  const auto at = slice(sliced.touch, data, beside, k, other[k] - beside.z[k],
                        {valley_slope(beside, k)}, kSettledPotential, work);
  if (!at) {
    return false;
  }
  // Of the other coordinates of the shape, whatever place and direction of the touch are.
  const TouchedMatrix covariance = inverse_cholesky(root_of(*at, k));
  const TouchedVector off = (other - at->z).cwiseQuotient(at->widths);
  double most = 0.0;
  for (int i = 0; i < shape_coordinates(sliced.touch.curve_class); ++i) {
    most = i != k ? std::max(most, off[i] * off[i] / covariance(i, i)) : most;
  }
  return most < 2.0 * kTailOfDensity;
}

}  // namespace

std::optional<ClassEvidence> by_slices(ClassEvidence evidence, const FitData& data,
                                       double inflation, Slices slices, WorkBudget& work) {
  TouchedCurve mode = std::move(evidence.nodes[evidence.mode].curve);
  const double weight = 1.0 / std::sqrt(inflation);
  if (const double ratio = weight / evidence.touch.weight; ratio != 1.0) {
    evidence.touch.weight = weight;
    evidence.fitted_chi2 *= ratio * ratio;
    work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
    auto counted = curve_at(evidence.touch, mode.z, mode, data);
    if (!counted) {
      return std::nullopt;
    }
    mode = *std::move(counted);
  }
  const Walk& how = slices == Slices::ForMoment ? kWalkForMoment : kWalkForMass;
  mode = descend(evidence.touch, data, std::move(mode), -1, work, kStepsFromFit, how.settled);
  const TouchedMatrix covariance = inverse_cholesky(mode.root);
  const int k = widest_coordinate(evidence.touch, mode, covariance, data, slices);
  double log_integral = log_mass(mode);
  evidence.widest = k;
  evidence.mode = 0;
  evidence.nodes = {{mode, 1.0}};
  if (k >= 0) {
    const double deviation = std::sqrt(covariance(k, k)) * mode.widths[k];
    const auto integral = integrate(data, deviation, how, &evidence, work);
    log_integral = integral.value_or(log_integral);
    evidence.widest = integral ? k : -1;
  }
  evidence.log_occam = log_integral + 0.5 * evidence.fitted_chi2 + evidence.log_all_modes;
  return is_of_optimum(evidence) ? std::optional(std::move(evidence)) : std::nullopt;
}

std::optional<double> share_of_other_mode(const ClassEvidence& sliced, const TouchedVector& other,
                                          const FitData& data, WorkBudget& work) {
  // In the log density. Two equal peaks of a normal law's width have it between them at four
  // deviations, where slices for a moment, which run over seven, pass both.
  constexpr double kDeepDip = 2.0;
  const auto& nodes = sliced.nodes;
  const int k = sliced.widest;
  const auto place = [&](std::size_t i) { return nodes[i].curve.z[k]; };
  if (nodes.size() < 2 || !(other[k] >= place(0) && other[k] <= place(nodes.size() - 1)) ||
      !runs_through(sliced, other, data, work)) {
    return std::nullopt;
  }
  // From the mode to the other's place, and on to the end.
  const bool ahead = other[k] > place(sliced.mode);
  const std::size_t last = ahead ? nodes.size() - 1 : 0;
  const double own = log_density(nodes[sliced.mode].curve, k);
  double dip = own;
  double peak = own;
  double beyond = 0.0;
  for (std::size_t i = sliced.mode; i != last;) {
    i = ahead ? i + 1 : i - 1;
    const double density = log_density(nodes[i].curve, k);
    const bool between = ahead ? place(i) < other[k] : place(i) > other[k];
    if (between && density < dip) {
      dip = peak = density;
      beyond = 0.0;
    } else {
      peak = std::max(peak, density);
      beyond += nodes[i].weight;
    }
  }
  return std::min(peak, own) - dip > kDeepDip ? beyond : 0.0;
}

}  // namespace palpate
