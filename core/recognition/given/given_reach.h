// How far the shape can really be moved before the points object: the profile of the likelihood.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/numerics/probability/mahalanobis.h"
#include "core/recognition/given/given_search.h"

namespace palpate {

/// A curve beside the fitted one: the step of the unknowns to it (curve_moves.h), and by how much
/// the sum of squares is larger there.
struct ReachPoint {
  std::array<double, kMostUnknowns> step{};
  double rise = 0.0;
  bool bend = false;  ///< the step is only what the way to that curve has left the straight way by
};

struct GivenReach {
  std::vector<ReachPoint> points;
  /// False if a shape parameter runs to the end of its class, or out of sight, before the sum of
  /// squares has risen by what was asked.
  bool bounded = true;
  /// Another curve, with a lower sum of squares, that the way came through.
  std::optional<PlacedCurve<double>> lower;
};

/// Deviations that differ by less are alike: no more than what ten touches know of their noise.
inline constexpr double kAlikeDeviations = 1.25;

/// What a walk does at a lower place than the minimum that it started from.
enum class AtLower {
  Stop,  ///< that place is to be looked at
  Pass,  ///< it is known to be none of the better minima
};

/// Moves each shape parameter either way, with all other unknowns at their best, until the sum of
/// squares has risen by `rise`. With a linear model the parameter would move by sqrt(rise) of the
/// deviations that a unit noise gives. Where it does, only the bend of the way is noted; a valley
/// that flattens is followed, and its points are noted. Of more than 256 points, neighbours along
/// the curve are taken together.
GivenReach reach_of(const GivenCandidate& minimum, double rise, AtLower at_lower = AtLower::Stop);

/// Widens the covariance of the unknowns, for unit noise, until each point of the reach lies no
/// further than sqrt(its rise) deviations. Across a valley that only bends, it is widened by the
/// bend: a point at its end then lies no further than sqrt(2 rise).
template <typename Matrix>
void widen(const GivenReach& reach, Matrix* covariance) {
  const Eigen::Index n = covariance->rows();
  constexpr double kBent = kAlikeDeviations * kAlikeDeviations - 1.0;
  for (const ReachPoint& point : reach.points) {
    const Eigen::VectorXd step = Eigen::Map<const Eigen::VectorXd>(point.step.data(), n);
    const double square = mahalanobis_square(step, *covariance);
    if (point.bend) {
      if (square > kBent * point.rise) {
        *covariance += 1.0 / point.rise * step * step.transpose();
      }
    } else if (square > point.rise && point.rise > 0.0) {
      // With C + k d d', the square of d becomes s / (1 + k s): the rise for this k.
      *covariance += (1.0 / point.rise - 1.0 / square) * step * step.transpose();
    }
  }
}

}  // namespace palpate
