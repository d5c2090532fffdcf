#include "core/recognition/coherent/coherent_moment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/curve.h"
#include "core/numerics/matrices/small_cholesky.h"
#include "core/recognition/coherent/coherent_cells.h"
#include "core/recognition/fit/inverse_information.h"

namespace palpate {
namespace {

constexpr int kOffsets = offset_coefficients(kHighestOrder);

/// A row of so many orders costs twice one of those that tell classes apart.
constexpr std::size_t kRowsOfMoment = 2;

/// What a drift leaves, and shape and pose, of which nothing is expected: about the estimate, and
/// linear in the offset's coefficients c.
struct ShapeAndLeft : LeftByDrift<kHighestOrder> {
  UnknownsMatrix covariance = UnknownsMatrix::Zero();  ///< of shape and pose, given c
  Unknowns away = Unknowns::Zero();
  Eigen::Matrix<double, kUnknowns, kOffsets> taken =
      Eigen::Matrix<double, kUnknowns, kOffsets>::Zero();  ///< shape and pose move by -taken c
};

ShapeAndLeft left_by(const WhiteRows<kHighestOrder>& white, const CanonicalFit& placed) {
  const Eigen::Index unknowns = placed.covariance.rows();
  const InverseInformation inverse =
      inverse_information(white.sums.topLeftCorner(unknowns, unknowns), placed.shape.curve_class,
                          placed.world_T_curve.theta);
  const auto with_offsets = white.sums.topRightCorner(unknowns, kOffsets);
  const auto with_residual = white.sums.col(kResidualColumn).head(unknowns);
  ShapeAndLeft left;
  left.covariance.topLeftCorner(unknowns, unknowns) = inverse.covariance;
  left.away.head(unknowns) = inverse.covariance * with_residual;
  left.taken.topRows(unknowns) = inverse.covariance * with_offsets;
  left.information = white.sums.bottomRightCorner<kOffsets, kOffsets>() -
                     with_offsets.transpose() * left.taken.topRows(unknowns);
  left.right = white.sums.col(kResidualColumn).tail<kOffsets>() -
               with_offsets.transpose() * left.away.head(unknowns);
  const double squares = white.sums(kResidualColumn, kResidualColumn);
  left.least_chi2 = rounding_of_chi2(squares);
  left.chi2 = std::max(squares - with_residual.dot(left.away.head(unknowns)), left.least_chi2);
  left.log_determinant = white.log_determinant + inverse.log_determinant;
  return left;
}

/// A weighted mean over cells.
struct Mixture {
  LogSum weights;
  UnknownsMatrix moment = UnknownsMatrix::Zero();
  double variance = 0.0;  ///< of the deviations at a point

  void add(double log_weight, const UnknownsMatrix& of_cell, double variance_of_cell) {
    const auto [before, weight] = weights.add(log_weight);
    moment = before * moment + weight * of_cell;
    variance = before * variance + weight * variance_of_cell;
  }
};

/// Adds the offsets of one size.
void add_offsets(const ShapeAndLeft& left, const Drift& drift, const OffsetSize& size,
                 const NoiseLaw& noise, double scatter, Mixture* mixture) {
  // No offset leaves less than nothing of what the drift has left.
  if (!mixture->weights.counts(size.log_prior + noise.log_evidence(scatter) -
                               0.5 * left.log_determinant)) {
    return;
  }
  const auto cells = offset_cells(left, size, noise, scatter);
  if (!cells ||
      std::none_of(cells->log_weight.begin(), cells->log_weight.end(),
                   [&](double log_weight) { return mixture->weights.counts(log_weight); })) {
    return;
  }
  Eigen::Matrix<double, kOffsets, kUnknowns, Eigen::RowMajor> taken =
      size.deviations.asDiagonal() * left.taken.transpose();
  solve_lower_rows(cells->lower, &taken);
  Unknowns away = left.away;
  double variance = drift.deviation * drift.deviation;
  UnknownsMatrix covariance = left.covariance;
  for (int i = 0; i < kOffsets; ++i) {
    const Unknowns row = taken.row(i).transpose();
    away -= cells->told[i] * row;
    covariance += row * row.transpose();
    if (i % 2 == 1) {
      continue;  // a cosine without its sine
    }
    // Of cosine and sine together, in any direction.
    variance += i > 0 ? size.deviations[i] * size.deviations[i] : 0.0;
    const auto order = static_cast<std::size_t>(i / 2);
    if (mixture->weights.counts(cells->log_weight[order])) {
      const double scale = noise.scale(cells->chi2[order]);
      mixture->add(cells->log_weight[order], scale * covariance + away * away.transpose(),
                   scale * variance);
    }
  }
}

/// The mean over all sizes, and the logarithm of the sum of the prior's weights.
struct OverSizes {
  Mixture mixture;
  double log_prior = 0.0;
};

OverSizes over_all_sizes(const std::vector<CoherentStep>& steps, const CanonicalFit& placed,
                         const NoiseLaw& noise, double scatter, double samples, WorkBudget& work) {
  double squares = 0.0;
  double weights = 0.0;
  for (const CoherentStep& step : steps) {
    squares += step.at.residual * step.at.residual / step.at.variance;
    weights += 1.0 / step.at.variance;
  }
  // Deviations: from 16 times the residuals (the shape would have absorbed all but a sixteenth)
  // down by factors of 4, at most four, to where the mean of all samples hides them.
  constexpr double kTakenUp = 16.0;
  constexpr int kDeviations = 5;
  const double longest = longest_run(steps);
  const double least = 1.0 / std::sqrt(samples);
  double deviation = std::max(kTakenUp * std::sqrt(squares / weights), 2.0 * least);
  OverSizes result;
  double prior = 0.0;
  for (int i = 0; i < kDeviations && deviation > least; ++i, deviation /= kSizeFactor) {
    for (int halvings = 1; halvings <= kMostHalvings; halvings += kPowerStep) {
      if (!work.allows()) {
        return {};
      }
      work.spend(WorkKind::DriftRow, kRowsOfMoment * steps.size());
      work.spend(WorkKind::OffsetCell, 1 + kLargestOffset - kLeastOffset);
      const Drift drift{deviation, std::ldexp(longest, -halvings)};
      const ShapeAndLeft left = left_by(white_rows<kHighestOrder>(steps, drift), placed);
      for (int power = kLeastOffset; power <= kLargestOffset; ++power) {
        const OffsetSize size = offset_size(drift, power);
        prior += kHighestOrder * std::exp(size.log_prior);
        add_offsets(left, drift, size, noise, scatter, &result.mixture);
      }
    }
  }
  result.log_prior = std::log(prior);
  return result;
}

}  // namespace

std::optional<CoherentMoment> coherent_moment(const CanonicalFit& placed, const FitData& reduced,
                                              const Likelihood& likelihood, double sigma,
                                              double scatter, WorkBudget& work) {
  const CurveClass curve_class = placed.shape.curve_class;
  const auto curve = make_curve(curve_class, placed.shape.values);
  const int rank = degrees_of_freedom(curve_class);
  const NoiseLaw noise(likelihood, rank);
  if (!curve || !can_tell_deviations(reduced, noise, rank)) {
    return std::nullopt;
  }
  std::vector<CoherentStep> steps = coherent_steps(placed, reduced, *curve, sigma);
  for (CoherentStep& step : steps) {
    step.at.variance *= likelihood.tempering;
  }
  scatter /= likelihood.tempering;
  const Eigen::Index unknowns = placed.covariance.rows();
  const auto [mixture, log_prior] =
      over_all_sizes(steps, placed, noise, scatter, likelihood.samples, work);
  const auto& [top, total] = mixture.weights;
  if (!(total > 0.0)) {
    return std::nullopt;
  }
  const ShapeAndLeft none = left_by(white_rows<kHighestOrder>(steps, {}), placed);
  const double log_none = noise.log_evidence(scatter + none.chi2) - 0.5 * none.log_determinant;
  CoherentMoment result;
  result.probability = 1.0 / (1.0 + std::exp(log_none + log_prior - top) / total);
  result.moment = (mixture.moment / total).topLeftCorner(unknowns, unknowns);
  result.deviation = sigma * std::sqrt(mixture.variance / total);
  return result;
}

}  // namespace palpate
