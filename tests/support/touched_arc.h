// Arcs of every class as a probe touches them: samples at equal arc lengths with Gaussian noise,
// and the true geometry that an estimate is measured against.
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
  int direction = 1;  ///< of travel against increasing t: 1 or -1
};

/// One arc of each class, of a part of about 25 mm, 22 mm long, off the vertices and with an
/// orientation of its own.
const std::vector<TouchedArc>& touched_arcs();

/// `count` points at equal arc lengths, ends included.
std::vector<Vec2> samples_of(const TouchedArc& arc, int count);

/// Isotropic Gaussian noise added.
std::vector<Vec2> with_noise(std::span<const Vec2> samples, double sigma_m, std::mt19937_64& rng);

/// True geometry at the foot of a world point, signed by the travel; covariance zero.
LocalEstimate truth_at(const TouchedArc& arc, const Vec2& world_point);

/// (offset along the left normal, tangent angle, kappa, kappa_s) less the truth at the foot of the
/// estimate's position.
Eigen::Vector4d error_of(const LocalEstimate& estimate, const TouchedArc& arc);

}  // namespace palpate::test
