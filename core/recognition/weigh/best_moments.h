// Covariances of the best class that hold more than a bound linear about the estimate.
#pragma once

#include <optional>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

struct BestMoments {
  /// About the estimate, where a covariance linear about it does not hold the class, or where
  /// neighbours err together.
  std::optional<ShapePoseCovariance> moment;
  /// The same for white noise of Weighing::inflation times the stated variance, over that.
  std::optional<ShapePoseCovariance> white_moment;
  /// Root mean square of what neighbours share at a point, as far as residuals tell of it;
  /// normalised.
  double coherent_deviation = 0.0;
};

/// Once for an answer: of several weighings only that which it is told from needs them.
BestMoments moments_of_best(const Weighing& weighing, WorkBudget& work);

/// What residuals tell of a smooth deviation, to a factor of the root of two and no less, so that
/// windows are not made anew wherever a sample changes it a little. [m]
double told_deviation_m(const BestMoments& moments, double scale_m);

}  // namespace palpate
