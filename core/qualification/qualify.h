// Qualifies a probe on an artefact of known shape: what it does to positions, and how well the
// samples tell.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/qualification/artefact.h"
#include "core/qualification/probe_character.h"

namespace palpate {

enum class QualificationStatus {
  Sufficient,      ///< the offset is known to less than the noise of a sample, in every direction
  Partial,         ///< the same, but in the directions that were touched only
  Insufficient,    ///< the samples leave the offset open by more than their noise
  NotFinite,       ///< a position or tip radius is no finite number, or a radius is negative
  BadArtefact,     ///< a line or no class: its offset is its place
  TooFewSamples,   ///< fewer than the unknowns need
  NotTheArtefact,  ///< the artefact cannot be laid on the samples
};

/// Lower-case words ("too few samples").
std::string_view name_of(QualificationStatus status);

struct QualificationOptions {
  bool bore = false;  ///< the material lies outside the curve; only asked where no tip radius tells
  /// Parts will be touched in the very set-up of these recordings, so that the offset's constant is
  /// the same. Otherwise it is another in each recording.
  bool same_setup = false;
  /// Probability that a recording without spikes loses a sample as one.
  double false_spike_probability = 0.01;
};

struct QualifiedSample {
  std::size_t recording = 0;
  std::size_t stroke = 0;
  std::size_t number = 0;     ///< in its stroke
  double normal_angle = 0.0;  ///< of the normal out of the material [rad]
  double distance_m = 0.0;    ///< out of the material, less the nominal tip radius
  double residual_m = 0.0;    ///< the same, less the offset
  bool spike = false;
};

struct Qualification {
  QualificationStatus status = QualificationStatus::NotFinite;
  ProbeCharacter probe;      ///< meaningful where Sufficient, Partial or Insufficient, as all below
  std::vector<Pose2> poses;  ///< of the artefact, by recording
  std::vector<QualifiedSample> samples;
  std::vector<double> order_probabilities;  ///< of no harmonics, of those to 2, to 3, ...
  /// Ranges of normal directions, counter-clockwise, wider than 30 degrees that no sample has.
  /// [rad]
  std::vector<std::pair<double, double>> untouched;
  double worst_offset_deviation_m = 0.0;  ///< over the touched directions
  bool both_directions = false;           ///< strokes ran both ways: the lag may be told
  bool bore = false;                      ///< as stated, or as the tips tell
};

/// Spikes are set aside by a robust fit; order, noise and coherence are weighed by their evidence;
/// offset, lag and poses are fitted under that noise. Linear in the samples, some hundred passes.
Qualification qualify(const Curve& artefact, std::span<const ArtefactRecording> recordings,
                      const QualificationOptions& options = {});

}  // namespace palpate
