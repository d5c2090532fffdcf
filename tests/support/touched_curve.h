// Scenes of a chosen shape touched at chosen places, and the theoretical limit of their accuracy.
#pragma once

#include <Eigen/Core>
#include <random>
#include <span>

#include "core/curves/curve.h"
#include "tests/support/random_scene.h"

namespace palpate::test {

/// A stroke along the curve, with samples at equal arc lengths.
struct Stroke {
  double centre_t = 0.0;
  double length_m = 0.0;
  int count = 111;
  int direction = 1;  ///< of travel: 1 along increasing t, -1 against it
};

/// Samples with isotropic Gaussian noise of `sigma_m`.
Scene touched_curve(const Curve& curve, const Pose2& world_T_curve, std::span<const Stroke> strokes,
                    double sigma_m, std::mt19937_64& rng);

/// The Kanatani-Cramer-Rao bound on the covariance of [shape; x; y; theta] at the truth, sigma^2
/// (J^T J)^-1 with rows n_i . d(world point)/dq. The entry of a circle's theta, which is free, is
/// 0.
Eigen::MatrixXd bound_of(const Scene& scene);

/// Natural units of the errors of [shape; x; y; theta]: the scene's half extent for lengths, 1 for
/// angles, the values themselves for the shape.
Eigen::VectorXd natural_sizes(const Scene& scene);

}  // namespace palpate::test
