// The samples of an artefact's recordings, placed on it, and which of them are spikes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/qualification/artefact.h"
#include "core/qualification/offset_fit.h"

namespace palpate {

/// The samples of all recordings in one sequence.
struct Ground {
  std::vector<ArtefactSample> samples;
  std::vector<StrokePlaces> strokes;
  std::vector<double> arc_m;
};

/// The samples of all recordings on the artefact, those that are spikes told.
struct ExplainedSamples {
  Ground ground;
  OffsetUnknowns unknowns;
  int highest_order = 0;       ///< that so many samples can tell
  std::vector<char> used;      ///< by sample: 0 for a spike
  double least_scale_m = 0.0;  ///< of residuals
};

/// With as many harmonics as possible, so that none is taken for spikes. `scale_m`: of the
/// residuals at `poses`. nullopt where the fit fails.
std::optional<ExplainedSamples> explained_samples(const Artefact& artefact,
                                                  std::span<const ArtefactRecording> recordings,
                                                  std::vector<Pose2> poses, double scale_m,
                                                  bool same_setup);

/// Keeps the coefficients that both orders have.
void set_order(OffsetUnknowns& unknowns, int order);

}  // namespace palpate
