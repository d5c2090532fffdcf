// How far a refinement goes.
#pragma once

#include <limits>

#include "core/numerics/probability/negligible.h"

namespace palpate {

struct RefineEffort {
  int iterations = 100;  ///< most iterations of one start
  /// Most starts: each begins where the last one stopped, until nothing changes (polynomial
  /// models).
  int starts = 6;
  /// Change of chi-square at which a start ends. Its square root is the remaining distance from the
  /// optimum, in standard deviations.
  double chi2_tolerance = 1e-7;
  /// A start is given up if its linear model leaves a larger chi-square than this.
  double out_of_reach = std::numeric_limits<double>::infinity();
  /// Corrects feet on the wrong arm (polynomial models).
  bool seek_feet = true;

  /// Relative tolerance of chi-square if the residuals are larger than any noise. The actual noise
  /// is then as large as the residuals, and a curve that is not the touched one only needs to come
  /// within a third of a standard deviation of its optimum: a tenth of chi-square, for all
  /// iterations together.
  double relative_tolerance(double residuals) const {
    constexpr double kThirdOfDeviation = 0.1;
    return kThirdOfDeviation / (iterations * most_of_noise(residuals));
  }
};

// Iterations bound the time. A well determined shape converges before; a fit that wanders on along
// a valley is not determined.

/// Separates impossible classes from possible ones.
inline constexpr RefineEffort kCoarseEffort{20, 1, 1e-3};
inline RefineEffort coarse(double out_of_reach) {
  RefineEffort effort = kCoarseEffort;
  effort.out_of_reach = out_of_reach;
  return effort;
}

/// For the plausible classes on the reduced points, and on all points if these disagree: to a tenth
/// of a standard deviation of the optimum.
inline constexpr RefineEffort kOnReducedEffort{80, 1, 1e-2};
inline constexpr RefineEffort kOnAllEffort{8, 1, 1e-2};

/// For the best class on the reduced points: these are few, so long valleys are walked here.
inline constexpr RefineEffort kBestOnReducedEffort{120, 1, 1e-5};

/// For the best class on all points: to its exact optimum. If it is not reached in so many steps,
/// the fit runs along a valley that is practically flat.
inline constexpr RefineEffort kPolishEffort{20, 2, 1e-6};

/// For a class that decides between classes and has not converged yet: to a hundredth of a standard
/// deviation.
inline RefineEffort thorough(double out_of_reach) { return {50, 1, 1e-4, out_of_reach}; }

}  // namespace palpate
