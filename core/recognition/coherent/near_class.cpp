#include "core/recognition/coherent/near_class.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/probability/log_add.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/coherent/coherent_cells.h"
#include "core/recognition/coherent/smooth_drift.h"
#include "core/recognition/posterior/evidences.h"

namespace palpate {
namespace {

constexpr int kColumns = kUnknowns + 1;  // shape and pose, and the residual

/// Largest deviation, in half extents: no class can be seen beyond. The least, four millionths, is
/// below what a probe can tell.
constexpr double kLargest = 0.25;
constexpr int kSizes = 9;  // by factors of 4
constexpr int kLengths = (kMostHalvings + kPowerStep - 1) / kPowerStep;

struct LeftBySmooth {
  double chi2 = 0.0;
  double log_determinant = 0.0;
};

/// What residuals leave under a drift, with normal priors of width 1 for shape and pose.
std::optional<LeftBySmooth> left_by_smooth(const std::vector<CoherentStep>& steps,
                                           const Drift& drift) {
  using Filter = SmoothDriftFilter<kColumns>;
  Filter filter(drift);
  Eigen::Matrix<double, kColumns, kColumns> sums =
      Eigen::Matrix<double, kColumns, kColumns>::Zero();
  double log_determinant = 0.0;
  for (const CoherentStep& step : steps) {
    const Filter::White white = filter.next(step.at, step.row.head<kColumns>().transpose());
    for (int k = 0; k < kColumns; ++k) {
      sums.row(k).head(k + 1) += white.row[k] * white.row.head(k + 1);
    }
    log_determinant += std::log(white.variance / step.at.variance);
  }
  UnknownsMatrix information =
      sums.topLeftCorner<kUnknowns, kUnknowns>() + UnknownsMatrix::Identity();
  information.triangularView<Eigen::StrictlyUpper>() = information.transpose();
  UnknownsMatrix lower;
  if (!cholesky(information, &lower)) {
    return std::nullopt;
  }
  const double squares = sums(kResidualColumn, kResidualColumn);
  const Unknowns told =
      solve_lower<kUnknowns>(lower, Unknowns(sums.row(kResidualColumn).head<kUnknowns>()));
  return LeftBySmooth{std::max(squares - told.squaredNorm(), rounding_of_chi2(squares)),
                      log_determinant + 2.0 * std::log(lower.diagonal().prod())};
}

/// The largest deviation that cannot count, whatever its length: the determinant is at most the
/// exponential of the trace.
double largest_hidden(const std::vector<CoherentStep>& steps) {
  double information = 0.0;
  for (const CoherentStep& step : steps) {
    information += 1.0 / step.at.variance;
  }
  return std::sqrt(2.0 * kStrongEvidence / information);
}

}  // namespace

std::optional<double> log_gain_near_class(const CanonicalFit& placed, const ClassEvidence& evidence,
                                          const FitData& reduced, const Likelihood& likelihood,
                                          double sigma, double scatter, double least_size,
                                          double least, WorkBudget& work) {
  const int coordinates = shape_coordinates(placed.shape.curve_class) + 2;
  const NoiseLaw noise(likelihood, coordinates);
  const auto steps = steps_by_coordinates(placed, evidence, reduced, likelihood, sigma);
  const double longest = steps ? longest_run(*steps) : 0.0;
  if (!(longest > 0.0) || !can_tell_deviations(reduced, noise, coordinates)) {
    return std::nullopt;
  }
  scatter /= likelihood.tempering;
  work.spend(WorkKind::DriftRow, steps->size());
  const auto none = left_by_smooth(*steps, {});
  if (!none) {
    return std::nullopt;
  }
  const double log_none = noise.log_evidence(scatter + none->chi2);
  const double highest = noise.log_evidence(scatter) - log_none;
  const double hidden = std::max(largest_hidden(*steps), least_size / sigma);
  double sum = kNoEvidence;
  for (int halvings = 1; halvings <= kMostHalvings; halvings += kPowerStep) {
    for (int size = kSizes - 1; size >= 0; --size) {
      const double deviation = std::ldexp(kLargest, -kPowerStep * size) / sigma;
      if (deviation <= hidden) {
        continue;
      }
      if (!work.allows()) {
        return std::nullopt;
      }
      work.spend(WorkKind::DriftRow, steps->size());
      const auto left = left_by_smooth(*steps, {deviation, std::ldexp(longest, -halvings)});
      const double cost = left ? 0.5 * (left->log_determinant - none->log_determinant) : 0.0;
      // A deviation counts if points that lie on the class speak strongly against it. Smaller ones
      // are hidden by the noise, and a part that has no others is of the class.
      if (cost < kStrongEvidence) {
        continue;
      }
      if (highest - cost < std::max(sum - kTailOfDensity, least)) {
        break;  // larger ones cost more
      }
      sum = log_add(sum, noise.log_evidence(scatter + left->chi2) - log_none - cost);
    }
  }
  return sum - std::log(kSizes * kLengths);
}

}  // namespace palpate
