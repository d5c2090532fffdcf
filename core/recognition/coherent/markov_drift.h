// A drift that neighbours along a run share: Markov's law, correlation exp(-distance / length).
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// One point of a run, in units of the typical noise.
struct DriftStep {
  std::size_t point = 0;
  double residual = 0.0;
  double variance = 1.0;  ///< of its noise
  /// Distance from the point before, normalised; infinite at the beginning of a run.
  double from_last = std::numeric_limits<double>::infinity();
};

/// The reduced points in the order of runs_along(). `sigma`: the typical noise, normalised.
std::vector<DriftStep> drift_steps(const CanonicalFit& placed, const FitData& reduced,
                                   double sigma);

struct Drift {
  double deviation = 0.0;  ///< standard deviation, in units of the typical noise
  double length = 1.0;     ///< correlation length, normalised
};

/// Kalman's recursion, which makes residuals white that contain such a drift.
class DriftFilter {
 public:
  explicit DriftFilter(const Drift& drift)
      : variance_(drift.deviation * drift.deviation), length_(drift.length), spread_(variance_) {}

  struct Gain {
    double kept = 0.0;      ///< factor on the drift expected at the point before
    double variance = 1.0;  ///< of the residual about its expectation
    double share = 0.0;     ///< share of the innovation that is due to drift
  };
  Gain next(const DriftStep& step) {
    const double kept = std::exp(-step.from_last / length_);
    spread_ = kept * kept * spread_ + (1.0 - kept * kept) * variance_;
    const double of_residual = spread_ + step.variance;
    const Gain gain{kept, of_residual, spread_ / of_residual};
    spread_ *= step.variance / of_residual;
    return gain;
  }

 private:
  double variance_;
  double length_;
  double spread_;
};

}  // namespace palpate
