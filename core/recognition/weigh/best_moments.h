// Covariances of the best class beyond the linear bound about the estimate.
#pragma once

#include <optional>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

struct BestMoments {
  /// Second moment about the estimate, if a linear covariance does not describe the class or if
  /// neighbours may be correlated.
  std::optional<ShapePoseCovariance> moment;
  /// The same with all noise taken as white (Weighing::inflation times the stated variance),
  /// divided by that inflation.
  std::optional<ShapePoseCovariance> white_moment;
  /// Root mean square of the deviation that neighbours share at a point, estimated from the
  /// residuals; normalised.
  double coherent_deviation = 0.0;
};

/// Once for an answer: of several weighings only that which it is told from needs them.
BestMoments moments_of_best(const Weighing& weighing, WorkBudget& work);

/// The next larger power of the root of two, of what windows are made by: so that they are not made
/// anew wherever a sample changes it a little.
double in_steps(double told);

/// What residuals tell of a smooth deviation, in such steps. [m]
double told_deviation_m(const BestMoments& moments, double scale_m);

}  // namespace palpate
