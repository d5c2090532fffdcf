// Qualifies a probe on an artefact of known shape: estimates what the probe does to positions, and
// how well the samples determine that.
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
  Sufficient,      ///< the offset is known to less than a sample's noise in every direction
  Partial,         ///< the same, but some directions were not touched
  Insufficient,    ///< the offset is less well known than that, or rather_another_size
  NotFinite,       ///< a position or tip radius is not finite, or a radius is negative
  BadArtefact,     ///< a line: its offset cannot be distinguished from its place
  TooFewSamples,   ///< fewer than the unknowns need
  NotTheArtefact,  ///< the artefact does not fit the samples
  SeveralTips,     ///< strokes state different tip radii: they are of several probes
};

/// Lower-case words, for example "too few samples".
std::string_view name_of(QualificationStatus status);

struct QualificationOptions {
  /// The material lies outside the curve; used only if no tip radius shows the side.
  bool bore = false;
  /// True: parts will be touched in the same set-up as these recordings, so the offset's constant
  /// is the same. False: the constant differs from recording to recording.
  bool same_setup = false;
};

struct QualifiedSample {
  std::size_t recording = 0;
  std::size_t stroke = 0;
  std::size_t number = 0;     ///< within the stroke
  double normal_angle = 0.0;  ///< of the normal out of the material [rad]
  double distance_m = 0.0;    ///< out of the material, minus the tip radius
  double residual_m = 0.0;    ///< distance minus the offset
  bool spike = false;
};

struct Qualification {
  QualificationStatus status = QualificationStatus::NotFinite;
  /// Valid if Sufficient, Partial or Insufficient; this holds for all that follows.
  ProbeCharacter probe;
  /// The samples state no tip radius, and that of `probe` is the constant of their distances
  /// (estimated_tip.h).
  bool tip_is_estimated = false;
  /// The offset's constant is more than a tenth of the stated tip radius: it is rather that the
  /// artefact or the tip has another size than stated. Samples do not tell these apart.
  bool rather_another_size = false;
  std::vector<Pose2> poses;  ///< of the artefact, one per recording
  std::vector<QualifiedSample> samples;
  std::vector<double> order_probabilities;  ///< of no harmonics, of harmonics up to 2, up to 3, ...
  /// Ranges of normal directions wider than 30 degrees without a sample, counter-clockwise. [rad]
  std::vector<std::pair<double, double>> untouched;
  /// Largest standard deviation of the offset over the touched directions. [m]
  double worst_offset_deviation_m = 0.0;
  bool both_directions = false;  ///< strokes ran both ways, so the lag can be determined
  bool bore = false;             ///< as stated, or as the tips show
};

/// Qualifies a probe from recordings on `artefact`. A robust fit removes spikes; evidence weighs
/// order, noise and coherence; then offset, lag and poses are fitted under that noise. Time is
/// linear in the samples: some hundred passes.
Qualification qualify(const Curve& artefact, std::span<const ArtefactRecording> recordings,
                      const QualificationOptions& options = {});

}  // namespace palpate
