// Noise that neighbouring samples share: each coordinate a first-order Markov process.
#pragma once

#include <cmath>
#include <random>

#include "tests/support/scene_prior.h"

namespace palpate::test {

/// The touches of a scene with noise of its standard deviation, of which neighbours correlate by
/// `correlation`, in [0, 1).
inline Scene with_shared_noise(const PriorScene& drawn, double correlation, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const auto any = [&] {
    const double x = normal(rng);
    return Vec2(x, normal(rng));
  };
  const double rest = std::sqrt(1.0 - correlation * correlation);
  Scene scene = drawn.scene;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    Vec2 error = any();
    for (std::size_t i = 0; i < scene.patches[p].size(); ++i) {
      error = i == 0 ? error : Vec2(correlation * error + rest * any());
      scene.patches[p][i] = drawn.exact_patches[p][i] + scene.sigma_m * error;
    }
  }
  return scene;
}

/// Of how many samples of such noise each counts as one.
inline double time_of_shared_noise(double correlation) {
  return (1.0 + correlation) / (1.0 - correlation);
}

}  // namespace palpate::test
