// Strokes of a probe that is not ideal, along a curve: every quality of a probe file at a known
// size.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/qualification/artefact.h"
#include "core/qualification/probe_character.h"

namespace palpate::test {

struct ProbeScene {
  Curve curve = Circle{0.025};
  Pose2 world_T_curve{0.1, -0.05, 0.3};
  double tip_radius_m = 2e-3;  ///< nominal
  double start_t = 0.0;
  double arc_t = 2.0 * kPi;  ///< of the curve parameter, touched by every stroke
  int strokes = 2;           ///< every other one runs back
  int samples = 300;         ///< of each stroke
  double spike_m = 2e-3;     ///< displaces a spike, in a random direction
  /// What the probe does; deviations of the estimates are not looked at.
  ProbeCharacter probe;
};

/// The material lies inside. Samples bring no noise of their own.
ArtefactRecording simulate(const ProbeScene& scene, std::mt19937_64& rng);

/// A probe with every quality: two and three lobes, drift, spikes and lag.
ProbeCharacter lobed_probe();

}  // namespace palpate::test
