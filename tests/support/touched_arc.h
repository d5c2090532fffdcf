// Arcs of every class as a probe touches them: samples at equal arc lengths with Gaussian noise,
// and the true geometry to compare an estimate with.
#pragma once

#include <Eigen/Core>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "core/local/local_estimate.h"

namespace palpate::test {

struct TouchedArc {
  std::string name;
  Curve curve;
  Pose2 world_T_curve;
  double centre_t = 0.0;  ///< curve parameter in the middle of the arc
  double length_m = 0.0;
  int direction = 1;  ///< of travel: 1 along increasing t, -1 against it
};

/// One arc of each class, 22 mm long on a part of about 25 mm, away from the vertices, each with
/// its own orientation.
const std::vector<TouchedArc>& touched_arcs();

/// `count` points at equal arc lengths, including both ends.
std::vector<Vec2> samples_of(const TouchedArc& arc, int count);

/// Adds isotropic Gaussian noise.
std::vector<Vec2> with_noise(std::span<const Vec2> samples, double sigma_m, std::mt19937_64& rng);

/// True geometry at the foot point of a world point, with signs by the direction of travel;
/// covariance zero.
LocalEstimate truth_at(const TouchedArc& arc, const Vec2& world_point);

/// (offset along the left normal, tangent angle, kappa, kappa_s) minus the truth at the foot point
/// of the estimate's position.
Eigen::Vector4d error_of(const LocalEstimate& estimate, const TouchedArc& arc);

}  // namespace palpate::test
