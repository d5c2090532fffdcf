// Scenes of a chosen shape, touched where one says, and the physical limit of what they can tell.
#pragma once

#include <Eigen/Core>
#include <random>
#include <span>

#include "core/curves/curve.h"
#include "tests/support/random_scene.h"

namespace palpate::test {

/// A stroke along the curve, samples at equal arc lengths.
struct Stroke {
  double centre_t = 0.0;
  double length_m = 0.0;
  int count = 111;
  int direction = 1;  ///< of travel against increasing t: 1 or -1
};

/// Samples with isotropic Gaussian noise of `sigma_m`.
Scene touched_curve(const Curve& curve, const Pose2& world_T_curve, std::span<const Stroke> strokes,
                    double sigma_m, std::mt19937_64& rng);

/// The Kanatani-Cramer-Rao bound on the covariance of [shape; x; y; theta] at the truth,
/// sigma^2 (J^T J)^-1 with rows n_i . d(world point)/dq. A circle's theta, which is free, has 0.
Eigen::MatrixXd bound_of(const Scene& scene);

/// Natural sizes of [shape; x; y; theta]: the scene's half extent for lengths, 1 for angles, the
/// values themselves for the shape. What an error is to be measured in.
Eigen::VectorXd natural_sizes(const Scene& scene);

}  // namespace palpate::test
