// Simulated strokes of a probe with known errors along a curve: every term of a probe file.
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
  double arc_t = 2.0 * kPi;  ///< range of the curve parameter that every stroke touches
  int strokes = 2;           ///< every other one runs backwards
  int samples = 300;         ///< of each stroke
  double spike_m = 2e-3;     ///< displacement of a spike, in a random direction
  /// The errors of the probe. The deviations of its estimates are not used.
  ProbeCharacter probe;
};

/// The material is inside. Samples state no noise.
ArtefactRecording simulate(const ProbeScene& scene, std::mt19937_64& rng);

/// A probe with all kinds of errors: two and three lobes, drift, spikes and lag.
ProbeCharacter lobed_probe();

}  // namespace palpate::test
