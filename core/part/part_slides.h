// Where along a part a patch may lie: every placement that fits, and the posterior over them.
#pragma once

#include <span>
#include <vector>

#include "core/part/part_fit.h"

namespace palpate {

/// One optimum of the pose.
struct PartCandidate {
  PartFit fit;        ///< over all three motions about the reference's position
  int direction = 1;  ///< +1: the reference's patch is travelled along increasing t, -1: against
  double t = 0.0;     ///< of the reference
  double probability = 0.0;  ///< among all candidates
};

struct SlidePosterior {
  std::vector<PartCandidate> candidates;  ///< most probable first
  /// Probability that the reference lies on each segment; zeros where there is no candidate.
  std::vector<double> segment_probability;
};

/// Which directions of travel the reference's patch may have along the part.
struct TravelDirections {
  bool along = true;
  bool against = true;
};

/// For the prior that is uniform over all poses, SE(2)'s own measure. A pose is the place t where
/// the part's normal passes through the reference point, the height over it and the turn from the
/// reference's tangent; that measure is then ds d(height) d(turn). For every t of a grid chi-square
/// is minimised over height and turn, whose integral is Gaussian; its minima over t are the
/// candidates, and the integral over t of what remains is taken numerically, between the barriers
/// that part the candidates. So a valley that is long, bent or flat counts by its true mass, not by
/// the curvature at its bottom. The reference needs a tangent. O(nodes * points) foot points.
SlidePosterior slide_posterior(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference, const TravelDirections& directions);

}  // namespace palpate
