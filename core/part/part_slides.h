// Where on a part the patches may lie: all placements that fit, and their posterior probabilities.
#pragma once

#include <span>
#include <vector>

#include "core/part/part_fit.h"

namespace palpate {

/// One optimum of the pose. The reference is the point that slide_posterior was given.
struct PartCandidate {
  PartFit fit;               ///< over all three motions, about the position of the reference
  int direction = 1;         ///< +1: the reference's patch runs along increasing t, -1: against it
  double t = 0.0;            ///< place of the reference on the part
  double probability = 0.0;  ///< share among all candidates
};

struct SlidePosterior {
  std::vector<PartCandidate> candidates;  ///< most probable first
  /// Probability that the reference lies on each segment; all 0 if there is no candidate.
  std::vector<double> segment_probability;
};

/// Sets the probabilities from the logarithms of the masses, one for each candidate and for each
/// segment, and sorts the candidates. Without any mass there are no candidates.
void set_probabilities(std::span<const double> log_masses, std::span<const double> by_segment,
                       SlidePosterior* posterior);

/// The directions of travel that the reference's patch may have along the part.
struct TravelDirections {
  bool along = true;
  bool against = true;
};

/// The posterior of the placement, under the prior that is uniform over all poses of SE(2).
///
/// A pose is described by the place t of the part that lies on the reference's normal, its height
/// over the reference, and its turn from the reference's tangent. In these coordinates the prior is
/// cos(turn) ds d(height) d(turn). For every t of a grid, chi-square is minimised over height and
/// turn, whose integral is Gaussian. The minima over t are the candidates. The integral over t is
/// numeric; barriers divide it among the candidates. So a long, bent or flat valley counts by its
/// true mass and not by the curvature at its bottom. `reference` needs a tangent. O(nodes * points)
/// foot points. Derivation: core/README.md, "A known closed part".
SlidePosterior slide_posterior(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference, const TravelDirections& directions);

}  // namespace palpate
