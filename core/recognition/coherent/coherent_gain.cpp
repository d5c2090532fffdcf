#include "core/recognition/coherent/coherent_gain.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/recognition/coherent/coherent_cells.h"

namespace palpate {
namespace {

using Left = LeftByDrift<kHighestOfClasses>;

/// The residuals under a drift, with normal priors of width 1 for the coordinates.
std::optional<Left> left_by(const std::vector<CoherentStep>& steps, const Drift& drift) {
  const auto white = white_rows<kHighestOfClasses>(steps, drift);
  UnknownsMatrix lower;
  const UnknownsMatrix information =
      white.sums.topLeftCorner<kUnknowns, kUnknowns>() + UnknownsMatrix::Identity();
  if (!cholesky(information, &lower)) {
    return std::nullopt;
  }
  constexpr int kOffsets = offset_coefficients(kHighestOfClasses);
  constexpr int kOthers = 1 + kOffsets;
  Eigen::Matrix<double, kUnknowns, kOthers, Eigen::RowMajor> half =
      white.sums.topRightCorner<kUnknowns, kOthers>();
  solve_lower_rows(lower, &half);
  const Eigen::Matrix<double, kOthers, kOthers> others =
      white.sums.bottomRightCorner<kOthers, kOthers>() - half.transpose().lazyProduct(half);
  Left left;
  left.least_chi2 = rounding_of_chi2(white.sums(kResidualColumn, kResidualColumn));
  left.chi2 = std::max(others(0, 0), left.least_chi2);
  left.right = others.col(0).tail<kOffsets>();
  left.information = others.bottomRightCorner<kOffsets, kOffsets>();
  left.log_determinant = white.log_determinant + 2.0 * std::log(lower.diagonal().prod());
  return left;
}

}  // namespace

std::optional<double> log_coherent_gain(const CanonicalFit& placed, const ClassEvidence& evidence,
                                        const FitData& reduced, const Likelihood& likelihood,
                                        double sigma, double scatter, double most,
                                        WorkBudget& work) {
  const CurveClass curve_class = placed.shape.curve_class;
  const int coordinates = shape_coordinates(curve_class) + 2;
  const NoiseLaw noise(likelihood, coordinates);
  const auto by_coordinates = steps_by_coordinates(placed, evidence, reduced, likelihood, sigma);
  if (!by_coordinates || !can_tell_deviations(reduced, noise, coordinates)) {
    return std::nullopt;
  }
  const std::vector<CoherentStep>& steps = *by_coordinates;
  scatter /= likelihood.tempering;
  work.spend(WorkKind::DriftRow, steps.size());
  const auto none = left_by(steps, {});
  if (!none) {
    return std::nullopt;
  }
  const double log_none = noise.log_evidence(scatter + none->chi2) - 0.5 * none->log_determinant;
  const double longest = longest_run(steps);
  const double least = 1.0 / std::sqrt(likelihood.samples);
  const double largest = std::min(most, 1.0 / least);
  LogSum sum{log_none};
  double prior = 0.0;
  for (double deviation = least; deviation <= largest; deviation *= kSizeFactor) {
    for (int halvings = 1; halvings <= kMostHalvings; halvings += kPowerStep) {
      if (!work.allows()) {
        return std::nullopt;
      }
      work.spend(WorkKind::DriftRow, steps.size());
      const Drift drift{deviation, std::ldexp(longest, -halvings)};
      const auto left = left_by(steps, drift);
      // The largest offsets leave the smallest chi-square.
      double least_chi2 = scatter;
      for (int power = kLargestOffset; power >= kLeastOffset; --power) {
        const OffsetSize size = offset_size(drift, power);
        if (size.deviations.maxCoeff() > most) {
          continue;
        }
        prior += kHighestOfClasses * std::exp(size.log_prior);
        if (!left || !sum.counts(size.log_prior + noise.log_evidence(least_chi2) -
                                 0.5 * left->log_determinant)) {
          continue;
        }
        work.spend(WorkKind::OffsetCell, 1);
        if (const auto cells = offset_cells(*left, size, noise, scatter)) {
          least_chi2 = std::max(least_chi2, cells->chi2.back());
          for (const double log_weight : cells->log_weight) {
            sum.add(log_weight);
          }
        }
      }
    }
  }
  if (!(prior > 0.0)) {
    return std::nullopt;
  }
  return std::log(0.5 * (std::exp(log_none - sum.top) + sum.total / prior)) + sum.top - log_none;
}

}  // namespace palpate
