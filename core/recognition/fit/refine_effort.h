// How far a refinement goes.
#pragma once

#include <algorithm>
#include <limits>

#include "core/numerics/negligible.h"

namespace palpate {

struct RefineEffort {
  int iterations = 100;  ///< of one start, at most
  /// Afresh from where the last one stopped, until nothing changes (polynomial models).
  int starts = 6;
  /// Change of chi-square at which a start ends: its root is the distance from the optimum, in
  /// standard deviations, that may be left.
  double chi2_tolerance = 1e-7;
  /// Of chi-square: a start of which the linear model leaves more is given up.
  double out_of_reach = std::numeric_limits<double>::infinity();
  /// Feet on the wrong arm are taken back (polynomial models).
  bool seek_feet = true;

  /// Of chi-square, where so many residuals leave more than any noise. Noise as large as they are
  /// is then what counts, and a curve that is not the one that was touched need be no nearer to its
  /// optimum than a third of a standard deviation, a tenth of chi-square: what all steps gain
  /// together that each gain less.
  double relative_tolerance(double residuals) const {
    constexpr double kThirdOfDeviation = 0.1;
    return kThirdOfDeviation / (iterations * most_of_noise(residuals));
  }
};

// Iterations bound the time: a well determined shape converges before, and what
// wanders on along a valley is not determined.

/// Tells classes that cannot be from those that may.
inline constexpr RefineEffort kCoarseEffort{20, 1, 1e-3};

/// For the plausible ones on the reduced points, and on all where these disagree: to a tenth of a
/// standard deviation of the optimum.
inline constexpr RefineEffort kOnReducedEffort{80, 1, 1e-2};
inline constexpr RefineEffort kOnAllEffort{8, 1, 1e-2};

/// For the best class on the reduced points: these are few, so that long valleys are walked here.
inline constexpr RefineEffort kBestOnReducedEffort{120, 1, 1e-5};

/// For the best class on all points: to its very optimum. What has none within so many steps runs
/// along a valley that is as good as flat.
inline constexpr RefineEffort kPolishEffort{20, 2, 1e-6};

/// For a class that is to be told from all others and has not arrived yet: to a hundredth of a
/// standard deviation.
inline RefineEffort thorough(double out_of_reach) { return {50, 1, 1e-4, out_of_reach}; }

}  // namespace palpate
