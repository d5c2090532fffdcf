// Noise that neighbouring samples share: each coordinate a first-order Markov process.
#pragma once

#include <cmath>
#include <random>

#include "tests/support/scene_prior.h"
#include "tests/support/shared_errors.h"

namespace palpate::test {

/// The touches of a scene with noise of its standard deviation, of which neighbours correlate by
/// `correlation`, in [0, 1).
inline Scene with_shared_noise(const PriorScene& drawn, double correlation, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  Scene scene = drawn.scene;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    SharedErrors errors(correlation);
    for (std::size_t i = 0; i < scene.patches[p].size(); ++i) {
      scene.patches[p][i] = drawn.exact_patches[p][i] + scene.sigma_m * errors.next(normal, rng);
    }
  }
  return scene;
}

/// Of how many samples of such noise each counts as one.
inline double time_of_shared_noise(double correlation) {
  return (1.0 + correlation) / (1.0 - correlation);
}

}  // namespace palpate::test
