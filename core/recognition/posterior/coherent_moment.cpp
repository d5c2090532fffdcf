#include "core/recognition/posterior/coherent_moment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/curve.h"
#include "core/numerics/small_cholesky.h"
#include "core/recognition/posterior/markov_drift.h"

namespace palpate {
namespace {

/// Orders of the offset by direction: the constant, and 2 to this. (The first is a shift.)
constexpr int kHighestOrder = 8;
constexpr int kOrders = kHighestOrder;
constexpr int kOffsets = 2 * kHighestOrder - 1;
constexpr int kUnknowns = 6;  ///< shape and pose
constexpr int kResidual = kUnknowns + kOffsets;
constexpr int kColumns = kResidual + 1;

/// Derivatives by shape and pose, those by the offset's coefficients, the residual.
using Row = Eigen::Matrix<double, kColumns, 1>;
using Sums = Eigen::Matrix<double, kColumns, kColumns>;
using Offsets = Eigen::Matrix<double, kOffsets, 1>;
using OffsetMatrix = Eigen::Matrix<double, kOffsets, kOffsets>;
using ShapePose = Eigen::Matrix<double, kUnknowns, 1>;
using Moment = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct RowStep {
  DriftStep at;
  Row row = Row::Zero();
};

/// Coefficients of one order have this index and, but for the constant, the next.
constexpr int first_of(int order) { return order == 0 ? 0 : 2 * order - 3; }

/// 1, cos 2 phi, sin 2 phi, cos 3 phi ... of the normal's direction phi.
Offsets offset_row(const Vec2& normal) {
  Offsets row;
  row[0] = 1.0;
  double cosine = normal.x();
  double sine = normal.y();
  for (int k = 2; k <= kHighestOrder; ++k) {
    const double next = cosine * normal.x() - sine * normal.y();
    sine = sine * normal.x() + cosine * normal.y();
    cosine = next;
    row[first_of(k)] = cosine;
    row[first_of(k) + 1] = sine;
  }
  return row;
}

std::vector<RowStep> steps_of(const CanonicalFit& placed, const FitData& reduced,
                              const Curve& curve, double sigma) {
  const auto letters =
      static_cast<Eigen::Index>(parameter_letters(placed.shape.curve_class).size());
  std::vector<RowStep> steps;
  steps.reserve(reduced.points.size());
  for (const DriftStep& at : drift_steps(placed, reduced, sigma)) {
    const FittedPoint& fitted = placed.points[at.point];
    const Vec2 normal = placed.world_T_curve.rotate_back(fitted.normal);
    RowStep step{at};
    step.row.head(letters) =
        position_by_parameters(curve, fitted.t).leftCols(letters).transpose() * normal;
    step.row.segment<2>(letters) = fitted.normal;
    step.row[letters + 2] = placed.shape.curve_class == CurveClass::Circle
                                ? 0.0  // a circle turns into itself
                                : normal.dot(left_of(position(curve, fitted.t)));
    step.row.head<kUnknowns>() /= sigma * reduced.scale;
    step.row.segment<kOffsets>(kUnknowns) = offset_row(fitted.normal);
    step.row[kResidual] = at.residual;
    steps.push_back(step);
  }
  return steps;
}

/// Of a drift along each patch.
struct Drift {
  double deviation = 0.0;  ///< in units of the typical noise
  double length = 1.0;     ///< normalised
};

/// The rows' products once such a drift is made white by Kalman's recursion.
struct WhiteRows {
  Sums sums = Sums::Zero();
  double log_determinant = 0.0;  ///< of their covariance over that of the noise alone
};

WhiteRows white_rows(const std::vector<RowStep>& steps, const Drift& drift) {
  WhiteRows result;
  Row mean = Row::Zero();
  DriftFilter filter(drift.deviation * drift.deviation, drift.length);
  for (const RowStep& step : steps) {
    const DriftFilter::Gain gain = filter.next(step.at);
    mean *= gain.kept;
    const Row surprise = step.row - mean;
    const Row weighted = surprise / gain.variance;
    for (int k = 0; k < kColumns; ++k) {
      result.sums.col(k).head(k + 1) += surprise[k] * weighted.head(k + 1);
    }
    result.log_determinant += std::log(gain.variance / step.at.variance);
    mean += gain.share * surprise;
  }
  result.sums.triangularView<Eigen::StrictlyLower>() = result.sums.transpose();
  return result;
}

/// What a drift leaves once shape and pose, of which nothing is expected, have taken up what they
/// can: about the estimate, and linear in the offset's coefficients c.
struct Left {
  ShapePoseCovariance covariance;  ///< of shape and pose, given c
  ShapePose away = ShapePose::Zero();
  Eigen::Matrix<double, kUnknowns, kOffsets> taken =
      Eigen::Matrix<double, kUnknowns, kOffsets>::Zero();  ///< shape and pose move by -taken c
  OffsetMatrix information;                                ///< of c
  Offsets right;                                           ///< that times the best c
  double chi2 = 0.0;                                       ///< without an offset
  double log_determinant = 0.0;
};

Left left_by(const WhiteRows& white, Eigen::Index unknowns, int rank) {
  const InverseInformation inverse =
      inverse_information(white.sums.topLeftCorner(unknowns, unknowns), rank);
  const auto with_offsets = white.sums.block(0, kUnknowns, unknowns, kOffsets);
  const auto with_residual = white.sums.col(kResidual).head(unknowns);
  Left left;
  left.covariance = inverse.covariance;
  left.away.head(unknowns) = inverse.covariance * with_residual;
  left.taken.topRows(unknowns) = inverse.covariance * with_offsets;
  left.information = white.sums.block<kOffsets, kOffsets>(kUnknowns, kUnknowns) -
                     with_offsets.transpose() * left.taken.topRows(unknowns);
  left.right = white.sums.col(kResidual).segment<kOffsets>(kUnknowns) -
               with_offsets.transpose() * left.away.head(unknowns);
  left.chi2 = white.sums(kResidual, kResidual) - with_residual.dot(left.away.head(unknowns));
  left.log_determinant = white.log_determinant + inverse.log_determinant;
  return left;
}

/// A mean over cells whose weights come as logarithms.
struct Mixture {
  double top = -kInfinite;
  double total = 0.0;
  Moment moment = Moment::Zero();
  double variance = 0.0;  ///< of the deviations at a point

  /// Whether anything of a cell would be seen beside those before.
  bool counts(double log_weight) const {
    constexpr double kNothing = 20.0;  // e^-20 of the highest, over some thousand cells
    return log_weight > top - kNothing;
  }
  void add(double log_weight, const Moment& of_cell, double variance_of_cell) {
    if (log_weight > top) {
      const double before = std::exp(top - log_weight);
      total *= before;
      moment *= before;
      variance *= before;
      top = log_weight;
    }
    const double weight = std::exp(log_weight - top);
    total += weight;
    moment += weight * of_cell;
    variance += weight * variance_of_cell;
  }
  double log_total() const { return top + std::log(total); }
};

/// Evidence by chi-square, and what variances count times: the noise is known or integrated out.
struct NoiseLaw {
  bool known = true;
  double degrees = 1.0;
  double log_evidence(double chi2) const {
    return known ? -0.5 * chi2 : -0.5 * degrees * std::log(chi2);
  }
  double scale(double chi2) const { return known ? 1.0 : chi2 / (degrees - 2.0); }
};

/// Size of a harmonic over that of the second: a deviation that bends nowhere sharply has overtones
/// that fall off with the square of their order.
constexpr double overtone(int order) { return order == 0 ? 1.0 : 4.0 / (order * order); }

/// The offset's size that a drift lets expect, by the same law: a deviation of length L takes 1 / L
/// half extents for a radian, as the harmonic of that order does.
double expected_offset(const Drift& drift) {
  const double order = std::clamp(1.0 / drift.length, 2.0, static_cast<double>(kHighestOrder));
  return drift.deviation / overtone(static_cast<int>(std::lround(order)));
}

/// log of Student's density with three degrees of freedom, of a positive size: flat where sizes are
/// as expected, with a tail of a power.
double log_student(double size) { return -2.0 * std::log1p(size * size / 3.0); }

/// Adds the offsets of one size (standard deviation of the constant and the second harmonic), the
/// highest order being any alike.
void add_offsets(const Left& left, const Drift& drift, double size, double log_prior,
                 const NoiseLaw& noise, double scatter, Mixture* mixture) {
  Offsets sizes;
  sizes[0] = size;
  for (int k = 2; k <= kHighestOrder; ++k) {
    sizes[first_of(k)] = sizes[first_of(k) + 1] = size * overtone(k);
  }
  OffsetMatrix matrix = sizes.asDiagonal() * left.information * sizes.asDiagonal();
  matrix.diagonal().array() += 1.0;
  OffsetMatrix lower;
  if (!cholesky(matrix, &lower)) {
    return;
  }
  const Offsets told = solve_lower<kOffsets>(lower, Offsets(sizes.cwiseProduct(left.right)));
  Eigen::Matrix<double, kOffsets, kUnknowns> taken;
  for (int k = 0; k < kUnknowns; ++k) {
    taken.col(k) =
        solve_lower<kOffsets>(lower, Offsets(sizes.cwiseProduct(left.taken.row(k).transpose())));
  }
  // The leading rows of a triangular root are those of the lower orders alone.
  double chi2 = scatter + left.chi2;
  double log_determinant = left.log_determinant;
  ShapePose away = left.away;
  double variance = drift.deviation * drift.deviation;
  Moment covariance = Moment::Zero();
  covariance.topLeftCorner(left.covariance.rows(), left.covariance.cols()) = left.covariance;
  for (int i = 0; i < kOffsets; ++i) {
    const ShapePose row = taken.row(i).transpose();
    chi2 -= told[i] * told[i];
    log_determinant += 2.0 * std::log(lower(i, i));
    away -= told[i] * row;
    covariance += row * row.transpose();
    if (i % 2 == 1) {
      continue;  // a cosine without its sine
    }
    variance += i > 0 ? sizes[i] * sizes[i] : 0.0;  // of both at any direction
    const double positive = std::max(chi2, std::numeric_limits<double>::min());
    const double log_weight = log_prior + noise.log_evidence(positive) - 0.5 * log_determinant;
    if (mixture->counts(log_weight)) {
      mixture->add(log_weight, noise.scale(positive) * covariance + away * away.transpose(),
                   noise.scale(positive) * variance);
    }
  }
}

/// Of the offsets over what is expected of them: factors of 2 from where that is nothing beside the
/// drift to where Student's law has one in a thousand left.
constexpr int kLeastSize = -3;
constexpr int kLargestSize = 3;

/// The mean over all sizes, and log of what the weights of the prior alone come to.
struct OverSizes {
  Mixture mixture;
  double log_prior = 0.0;
};

OverSizes over_all_sizes(const std::vector<RowStep>& steps, Eigen::Index unknowns, int rank,
                         const NoiseLaw& noise, double scatter, double samples) {
  double squares = 0.0;
  double longest = 0.0;
  double run = 0.0;
  for (const RowStep& step : steps) {
    squares += step.row[kResidual] * step.row[kResidual];
    run = std::isfinite(step.at.from_last) ? run + step.at.from_last : 0.0;
    longest = std::max(longest, run);
  }
  // Deviations: from where the mean of all samples hides them to where the shape would have taken
  // up all but a sixteenth, by factors of 2, at most eight. Lengths: from half of the longest run,
  // beyond which they are a constant, by halves to a thirty-second.
  constexpr double kTakenUp = 16.0;
  constexpr int kDeviations = 9;
  constexpr int kLengths = 5;
  const double least = 1.0 / std::sqrt(samples);
  double deviation =
      std::max(kTakenUp * std::sqrt(squares / static_cast<double>(steps.size())), 2.0 * least);
  OverSizes result;
  double prior = 0.0;
  for (int i = 0; i < kDeviations && deviation > least; ++i, deviation *= 0.5) {
    for (int k = 1; k <= kLengths; ++k) {
      const Drift drift{deviation, std::ldexp(longest, -k)};
      const Left left = left_by(white_rows(steps, drift), unknowns, rank);
      const double expected = expected_offset(drift);
      for (int j = kLeastSize; j <= kLargestSize; ++j) {
        const double ratio = std::ldexp(1.0, j);
        const double log_prior = std::log(ratio) + log_student(ratio);  // by its logarithm
        prior += kOrders * std::exp(log_prior);
        add_offsets(left, drift, ratio * expected, log_prior, noise, scatter, &result.mixture);
      }
    }
  }
  result.log_prior = std::log(prior);
  return result;
}

}  // namespace

std::optional<CoherentMoment> coherent_moment(const CanonicalFit& placed, const FitData& reduced,
                                              const Likelihood& likelihood, double sigma,
                                              double scatter) {
  const CurveClass curve_class = placed.shape.curve_class;
  const auto curve = make_curve(curve_class, placed.shape.values);
  const int rank = degrees_of_freedom(curve_class);
  const NoiseLaw noise{likelihood.sigma_known, likelihood.samples - rank};
  if (!curve || static_cast<int>(reduced.points.size()) <= rank || noise.degrees <= 2.0 ||
      residual_count(reduced) > reduced.points.size()) {
    return std::nullopt;
  }
  const std::vector<RowStep> steps = steps_of(placed, reduced, *curve, sigma);
  const Eigen::Index unknowns = placed.covariance.rows();
  const auto [mixture, log_prior] =
      over_all_sizes(steps, unknowns, rank, noise, scatter, likelihood.samples);
  if (!(mixture.total > 0.0)) {
    return std::nullopt;
  }
  const Left none = left_by(white_rows(steps, {0.0, 1.0}), unknowns, rank);
  const double log_none = noise.log_evidence(scatter + none.chi2) - 0.5 * none.log_determinant;
  CoherentMoment result;
  result.probability = 1.0 / (1.0 + std::exp(log_none + log_prior - mixture.log_total()));
  result.moment = (mixture.moment / mixture.total).topLeftCorner(unknowns, unknowns);
  result.deviation = sigma * std::sqrt(mixture.variance / mixture.total);
  return result;
}

}  // namespace palpate
