// How far the shape can really be moved before the points object: the profile of the likelihood.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/recognition/given/given_search.h"

namespace palpate {

/// A curve beside the fitted one: the step of the unknowns to it (curve_moves.h), and by how much
/// the sum of squares is larger there.
struct ReachPoint {
  std::array<double, kMostUnknowns> step{};
  double rise = 0.0;
};

struct GivenReach {
  std::vector<ReachPoint> points;
  /// False if a shape parameter runs to the end of its class, or out of sight, before the sum of
  /// squares has risen by what was asked.
  bool bounded = true;
  /// Another curve, with a lower sum of squares, that the way came through.
  std::optional<PlacedCurve<double>> lower;
};

/// Moves each shape parameter either way, with all other unknowns at their best, until the sum of
/// squares has risen by `rise`. With a linear model the parameter would move by sqrt(rise) of the
/// deviations that a unit noise gives. Where it does, nothing is noted; a valley that bends or
/// flattens is followed, and its points are noted. At most 256 points are looked at, for more ones
/// hide no bend of the valley that few show.
GivenReach reach_of(const GivenCandidate& minimum, double rise);

/// Widens the covariance of the unknowns, for unit noise, until each point of the reach lies no
/// further than sqrt(its rise) deviations.
template <typename Matrix>
void widen(const GivenReach& reach, Matrix* covariance) {
  for (const ReachPoint& point : reach.points) {
    const Eigen::Index n = covariance->rows();
    const Eigen::Map<const Eigen::VectorXd> step(point.step.data(), n);
    const Eigen::VectorXd scale = covariance->diagonal().cwiseSqrt();
    const Eigen::MatrixXd unit =
        scale.cwiseInverse().asDiagonal() * *covariance * scale.cwiseInverse().asDiagonal();
    const Eigen::VectorXd u = step.cwiseQuotient(scale);
    const double square = u.dot(unit.ldlt().solve(u));
    // With C + k d d', the square of d becomes s / (1 + k s): the rise for this k.
    if (square > point.rise && point.rise > 0.0) {
      *covariance += (1.0 / point.rise - 1.0 / square) * step * step.transpose();
    }
  }
}

}  // namespace palpate
